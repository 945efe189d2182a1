// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_pass.hpp"

#include "tests/io/io_support.hpp"
#include "tests/support/memory_scan.hpp"

namespace lacuna::test {
namespace {

const std::string kIntegers =
    ascii_ply("255 -300 70000\n1 2 3\n", "property uchar x\nproperty short y\nproperty int z\n");
const std::string kNormals =
    ascii_ply("1 0.1 5 6 0 0.5\n", "property float nz\n" + kXyz + "property float nx\nproperty float ny\n");
const std::string kEmpty = ascii_ply("");

}  // namespace

TEST_CASE("several files are one scan, in double, with ids over all rows", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan(
      {folder.write("a.ply", kIntegers), folder.write("b.ply", kEmpty), folder.write("c.ply", kNormals)}, {});
  ScanPass pass(scan);
  CHECK(pass.expected_points() == 3u);
  CHECK(scan.has_normals());
  CHECK_FALSE(has_single_precision(scan));
  for (int time = 0; time < 2; ++time) {
    const Cloud all = read_points(pass);
    REQUIRE(all.size() == 3);
    CHECK(all.positions[0] == Eigen::Vector3d(255, -300, 70000));
    CHECK(all.positions[1] == Eigen::Vector3d(1, 2, 3));
    CHECK(all.positions[2] == Eigen::Vector3d(0.1f, 5, 6));
    REQUIRE(all.normals.size() == 3);
    CHECK(std::isnan(all.normals[0].x()));
    CHECK(std::isnan(all.normals[1].z()));
    CHECK(all.normals[2] == Eigen::Vector3d(0, 0.5, 1));
    pass.rewind();
  }
}

TEST_CASE("rewinding in the middle starts from the first point", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.ply", kNormals), folder.write("c.ply", kNormals)}, {});
  ScanPass pass(scan);
  PointBatch batch;
  REQUIRE(pass.next(batch));
  pass.rewind();
  CHECK(read_points(pass).positions.size() == 2);
  CHECK(has_single_precision(scan));
}

TEST_CASE("a scan without normals has none, and a text file does not say its size", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.ply", kEmpty), folder.write("b.xyz", "1 2 3\n")}, {});
  ScanPass pass(scan);
  CHECK_FALSE(scan.has_normals());
  CHECK_FALSE(scan.expected_points());
  const Cloud all = read_points(pass);
  CHECK(all.size() == 1);
  CHECK(all.normals.empty());
}

TEST_CASE("a scan is read in batches of bounded size", "[io]") {
  const ScratchFolder folder;
  std::string text;
  for (int i = 0; i < 70'000; ++i) text += "1 2 3\n";
  const ScanFiles scan({folder.write("a.xyz", text)}, {});
  ScanPass pass(scan);
  PointBatch batch;
  REQUIRE(pass.next(batch));
  CHECK(batch.size() == 65'536);
  REQUIRE(pass.next(batch));
  CHECK(batch.size() == 70'000 - 65'536);
  CHECK(value(batch.first) == 65'536);
  CHECK_FALSE(pass.next(batch));
}

TEST_CASE("a missing or broken file is an error before any point is read", "[io]") {
  const ScratchFolder folder;
  const auto good = folder.write("a.ply", kNormals);
  CHECK(error_of([&] { ScanFiles({good, folder / "none.ply"}, {}); }).find("none.ply") != std::string::npos);
  const auto cut = folder.write("cut.ply", kNormals.substr(0, kNormals.size() - 8));
  CHECK(error_of([&] { ScanFiles({good, cut}, {}); }).find("cut.ply") != std::string::npos);
}

// Keeps size and time.
void replace_by_copy(const fs::path& file) {
  const auto copy = fs::path(file).concat(".copy");
  fs::copy_file(file, copy);
  fs::last_write_time(copy, fs::last_write_time(file));
  fs::rename(copy, file);
}

TEST_CASE("a file that is not the one that was opened first is an error that says what differs", "[io]") {
  const ScratchFolder folder;
  const auto write = [&] { return folder.write("b.ply", kNormals); };
  const auto later = [](const auto& file, int milliseconds) {
    const auto time = fs::last_write_time(file);
    fs::last_write_time(file, time + std::chrono::milliseconds(milliseconds));
  };
  const auto write_with_time_set_back = [](const auto& file) {
    const auto time = fs::last_write_time(file);
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(-2, std::ios::end) << "9";
    fs::last_write_time(file, time);
  };
  const std::vector<std::pair<std::string, std::function<void(const fs::path&)>>> changes = {
      {"its content, names, owner or permissions", write_with_time_set_back},
      {"another file", replace_by_copy},
      {"bytes", [&](const auto&) { folder.write("b.ply", kNormals + "\n"); }},
      {"written to", [&](const auto& file) { later(file, 1); }},
      {"written to", [&](const auto& file) { later(file, -1); }},
      {"cannot be found", [](const auto& file) { fs::remove(file); }}};
  for (const auto& [named, change] : changes) {
    const fs::path file = write();
    const ScanFiles scan({folder.write("a.ply", kNormals), file}, {});
    ScanPass pass(scan);
    CHECK(error_of([&] { scan.check_unchanged(); }).empty());
    CHECK(read_points(pass).positions.size() == 2);
    std::this_thread::sleep_for(
        std::chrono::milliseconds(20));  // more than a tick of the file system's clock
    change(file);
    for (const std::string& error :
         {error_of([&] { scan.check_unchanged(); }), error_of([&] { scan.open(1); }), error_of([&] {
            pass.rewind();
            read_points(pass);
          })}) {
      INFO(error);
      CHECK(error.find(file.string() + ": has changed during the run (") == 0);
      CHECK(error.find(named) != std::string::npos);
    }
    CHECK(scan.open(0)->expected_rows() == 1u);
  }
}

TEST_CASE("a point too far away is an error that names its file and its place in it", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.xyz", "1 2 3\n"), folder.write("b.xyz", "1 2 3\n1 -1e200 3\n")}, {});
  ScanPass pass(scan);
  CHECK_THAT(error_of([&] { read_points(pass); }),
             Contains("b.xyz: point 1 lies at 1 -1e+200 3; coordinates must be within 1e30"));
  const ScanFiles bounded_files({folder.write("b.xyz", "1 2 3\n1 -1e200 3\n")}, {.bounds = {0, 0, 9, 9}});
  ScanPass bounded(bounded_files);
  CHECK(error_of([&] { read_points(bounded); }).empty());
}

TEST_CASE("passes over some files count what one over all of them counts", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan(
      {folder.write("a.xyz", "1 2 3\n40 5 6\n"), folder.write("b.xyz", "7 8 9\nnan 0 0\n7 8 90\n")},
      {.bounds = {0, 0, 0, 9, 9, 9}});
  ScanPass whole(scan), task(scan);
  read_points(whole);
  std::vector<std::uint64_t> counts(whole.pass_counts().size());
  for (const std::size_t file : {0, 1}) {
    task.rewind_to({file, file + 1}, PointId{0});
    read_points(task);
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += task.pass_counts()[i];
  }
  CHECK(counts == whole.pass_counts());
  CHECK(whole.counts().filtered_out.bounds == 2);
  CHECK(rows_of(scan, whole.counts()) == std::vector<std::uint64_t>{2, 3});
  task.rewind();
  CHECK(read_points(task).size() == 5);
}

}  // namespace lacuna::test
