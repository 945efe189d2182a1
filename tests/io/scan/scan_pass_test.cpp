// SPDX-License-Identifier: Apache-2.0
// Files as one scan: their points in batches, the poses of files, which points take part, and degrees.
#include "io/read/scan/scan_pass.hpp"

#include "io/read/rows/pose.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

// ---- Files as one scan

const std::string kIntegers =
    ascii_ply("255 -300 70000\n1 2 3\n", "property uchar x\nproperty short y\nproperty int z\n");
const std::string kNormals =
    ascii_ply("1 0.1 5 6 0 0.5\n", "property float nz\n" + kXyz + "property float nx\nproperty float ny\n");
const std::string kEmpty = ascii_ply("");

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

// ---- Poses

// A quarter turn around z, then a move.
constexpr const char* kMatrix = "0 -1 0 10\n1 0 0 20\n0 0 1 30\n0 0 0 1\n";

TEST_CASE("a pose is a matrix, its first three rows, or a translation and a quaternion") {
  const Pose matrix = parse_pose(kMatrix);
  CHECK(matrix * Eigen::Vector3d(1, 2, 3) == Eigen::Vector3d(8, 21, 33));
  CHECK(parse_pose("0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30").matrix() == matrix.matrix());
  const double half = std::sqrt(0.5);
  const Pose turned = parse_pose("10 20 30 0 0 " + std::to_string(half) + " " + std::to_string(half));
  CHECK((turned.matrix() - matrix.matrix()).norm() < 1e-5);
  CHECK(parse_pose("1000 0 0 5 0 1000 0 6 0 0 1000 7") * Eigen::Vector3d(1, 2, 3) ==
        Eigen::Vector3d(1005, 2006, 3007));
}

TEST_CASE("what does not only turn, scale and move is no pose") {
  const std::string odd = "shears, mirrors or flattens";
  check_reasons({{"1 2 3", "a pose of 3 numbers; allowed: 16"},
                 {"1 2 3 0 0 0 2", "the quaternion of a pose has length 2"},
                 {"1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1", "may be transposed"},
                 {"1 0 0 0 0 1 0 0 0 0 -1 0", odd},
                 {"1 0 0 0 0 1 0 0 0 0 0 0", odd},
                 {"0 0 0 0 0 0 0 0 0 0 0 0", odd},
                 {"1 0.1 0 0 0 1 0 0 0 0 1 0", odd},
                 {"1 0 0 0 0 one 0 0 0 0 1 0", "'one' is no number of a pose"},
                 {"1 0 0 nan 0 1 0 0 0 0 1 0", "'nan' is no number of a pose"}},
                [](const std::string& numbers) { return error_of([&] { parse_pose(numbers); }); });
}

TEST_CASE("a file of a pose that holds none is an error that names it") {
  const ScratchFolder folder;
  CHECK(read_pose(folder.write("a.xf", kMatrix)).matrix() == parse_pose(kMatrix).matrix());
  CHECK_THAT(error_of([&] { read_pose(folder.write("b.xf", "1 0 0\n")); }), Contains("b.xf: a pose of 3"));
  CHECK_THAT(error_of([&] { read_pose(folder / "none.xf"); }), Contains("none.xf"));
}

TEST_CASE("a pose moves positions, turns normals without scaling them, and keeps all else") {
  const ScratchFolder folder;
  const auto ply = folder.write(
      "a.ply",
      ascii_ply("200 1 2 3 1 0 0\n",
                "property uchar red\n" + kXyz + "property float nx\nproperty float ny\nproperty float nz\n"));
  const Pose pose = parse_pose("0 -2 0 10  2 0 0 20  0 0 2 30");
  const ScanFiles scan({{ply, pose}, {ply}}, {});
  CHECK(scan.files()[0].layout.find("x")->type == Scalar::kFloat64);
  CHECK(scan.files()[0].layout.find("red")->type == Scalar::kUint8);
  CHECK_FALSE(has_single_precision(scan));
  ScanPass pass(scan);
  PointBatch batch;
  REQUIRE(pass.next(batch));
  CHECK(batch.positions[0] == Eigen::Vector3d(6, 22, 36));
  CHECK((batch.normals[0] - Eigen::Vector3d(0, 1, 0)).norm() < 1e-15);
  REQUIRE(pass.next(batch));
  CHECK(batch.positions[0] == Eigen::Vector3d(1, 2, 3));

  const auto reader = scan.open(0);
  RowBatch rows;
  REQUIRE(reader->next(rows, 10));
  CHECK(rows.bytes[reader->layout().find("red")->offset] == std::byte{200});
}

// ---- Which points take part

const std::string kRows =
    "x y z Classification ReturnNumber NumberOfReturns\n"
    "0 0 0 2 1 1\n"
    "1 1 1 2 1 2\n"
    "2 2 2 6 2 2\n"
    "3 3 3 6 1 1\n"
    "4 4 4 1 2 3\n"
    "nan 5 5 2 1 1\n";

struct Filtered {
  std::vector<int> kept;  // rows with a finite position
  FilteredOut out;
};

Filtered read_filtered(const std::vector<ScanInput>& inputs, const InputConfig& config) {
  const ScanFiles scan(inputs, config);
  ScanPass pass(scan);
  Filtered filtered;
  for (int time = 0; time < 2; ++time) {  // counts are of one pass
    filtered.kept.clear();
    pass.rewind();
    for (PointBatch batch; pass.next(batch);) {
      for (std::size_t i = 0; i < batch.size(); ++i)
        if (batch.positions[i].allFinite()) filtered.kept.push_back(static_cast<int>(value(batch.id(i))));
    }
  }
  if (filtered.kept.empty()) pass.refuse_empty();
  filtered.out = pass.counts().filtered_out;
  return filtered;
}

Filtered read_rows(const InputConfig& config) {
  const ScratchFolder folder;
  return read_filtered({folder.write("a.csv", kRows)}, config);
}

TEST_CASE("without a filter every finite point takes part") {
  const Filtered all = read_rows({});
  CHECK(all.kept == std::vector{0, 1, 2, 3, 4});
  CHECK(all.out.total() == 0);
}

TEST_CASE("bounds keep their faces, and are open in z where they have four numbers") {
  const Filtered flat = read_rows({.bounds = {1, 1, 3, 3}});
  CHECK(flat.kept == std::vector{1, 2, 3});
  CHECK(flat.out.bounds == 2);
  CHECK(read_rows({.bounds = {0, 0, 1.5, 9, 9, 9}}).kept == std::vector{2, 3, 4});
}

TEST_CASE("each row is counted by the first filter that refuses it, in each pass anew") {
  const ScratchFolder folder;
  const Filtered filtered =
      read_filtered({folder.write("a.csv", kRows + "2 1 2 2 2 2\n")},
                    {.bounds = {-1, -1, 3, 3}, .drop_origin = true, .where = "Classification == 2"});
  CHECK(filtered.kept == std::vector{1, 6});
  CHECK(filtered.out.origin == 1);  // row 0
  CHECK(filtered.out.bounds == 1);  // row 4
  CHECK(filtered.out.where == 2);   // rows 2 and 3
}

TEST_CASE("filters that leave no point are an error that names each of them and what there is") {
  const auto error = [](const InputConfig& config) { return error_of([&] { read_rows(config); }); };
  CHECK_THAT(error({.bounds = {10, 10, 11, 11}}),
             Contains("--bounds leaves out 5, the scan lies from 0 0 0 to 4 4 4"));
  CHECK(error({.bounds = {-1, -1, 3, 3}, .drop_origin = true, .where = "Classification == 1"}) ==
        "the filters leave none of the 5 points: --drop-origin leaves out 1; --bounds leaves out 1, the scan "
        "lies from 1 1 1 to 4 4 4; --where leaves out 3");
}

TEST_CASE("withheld points and noise of LAS do not take part, unless they are kept") {
  const ScratchFolder folder;
  const auto las = [&](const std::vector<int>& classes) {
    return folder.write("a.las", las_of_classes(classes));
  };
  constexpr int kWithheld = 128;
  const auto file = las({2, 7, 18, 2 | kWithheld, 7 | kWithheld});
  const Filtered usual = read_filtered({file}, {});
  CHECK(usual.kept == std::vector{0});
  CHECK(usual.out.withheld == 2);
  CHECK(usual.out.noise == 2);
  CHECK(read_filtered({file}, {.keep_withheld = true}).kept == std::vector{0, 3});
  CHECK(read_filtered({file}, {.keep_noise = true}).kept == std::vector{0, 1, 2});
  CHECK(read_filtered({file}, {.keep_noise = true, .where = "Classification == 7"}).kept == std::vector{1});
  const std::vector<ScanInput> posed = {{file, parse_pose("1 2 3 0 0 0 1")}};
  CHECK(read_filtered(posed, {}).out.noise == 2);
  CHECK_THAT(error_of([&] { read_filtered({las({7})}, {}); }),
             Contains("1 are noise, which --keep-noise keeps"));
}

TEST_CASE("filters that leave no point of one file are no error where another file has points") {
  const ScratchFolder folder;
  const auto noise = folder.write("a.las", las_of_classes({7})),
             text = folder.write("b.txt", "x y z\n1 2 3\n");
  CHECK(read_filtered({noise, text}, {}).kept == std::vector{1});
}

TEST_CASE("the classes 7 and 18 of other formats than LAS are labels, which take part") {
  const ScratchFolder folder;
  const auto csv = folder.write("a.csv", "x,y,z,Classification,Withheld\n1,1,1,7,0\n2,2,2,18,0\n3,3,3,7,1\n");
  const auto ply =
      folder.write("a.ply", ascii_ply("1 1 1 7\n2 2 2 18\n", kXyz + "property uchar classification\n"));
  CHECK(read_filtered({csv}, {}).kept == std::vector{0, 1});
  CHECK(read_filtered({ply}, {}).kept == std::vector{0, 1});
}

TEST_CASE("a condition of any attributes says which points take part") {
  const ScratchFolder folder;
  const auto file = folder.write("a.txt", kRows);
  const auto kept = [&](const std::string& where) { return read_filtered({file}, {.where = where}).kept; };
  CHECK(kept("Classification == 2") == std::vector{0, 1});
  CHECK(kept("classification = 6 AND return_number != 1") == std::vector{2});
  CHECK(kept("Classification==6 or NumberOfReturns>=3") == std::vector{2, 3, 4});
  CHECK(kept("not (Classification == 6 || x < 1) && z <= 3.5") == std::vector{1});
  CHECK(kept("x > -1 and !(y > 2)") == std::vector{0, 1, 2});
  CHECK(kept("ReturnNumber == NumberOfReturns") == std::vector{0, 2, 3});
  CHECK(kept("scalar_Return_Number < number_of_returns") == std::vector{1, 4});
  CHECK(read_filtered({file}, {.where = "x > 2"}).out.where == 3);
  check_reasons({{"Colour == 2", "a.txt: no column for 'Colour' of --where; the columns are x, y, z,"},
                 {"x == red", "no column for 'red' of --where"},
                 {"x ~ 2", "--where 'x ~ 2': '~' is no comparison; allowed: comparisons"},
                 {"(x == 2", "a parenthesis is not closed"},
                 {"x == 2 y == 3", "a comparison ends before 'y'"},
                 {"x == 2 and", "a comparison is missing at the end"},
                 {std::string(1000, '('), "nested too deeply"},
                 {"x > 9", "--where leaves out 5"}},
                [&](const std::string& where) { return error_of([&] { kept(where); }); });
}

TEST_CASE("a condition takes the column of its very name, or the only one that is spelled alike") {
  const ScratchFolder folder;
  const auto file = folder.write("a.txt", "x y z Band_1 band1 Band2\n0 0 0 1 2 3\n");
  const auto kept = [&](const std::string& where) { return read_filtered({file}, {.where = where}).kept; };
  for (const char* where : {"band1 == 2", "Band_1 == 1", "band_2 == 3", "\"band 2\" == 3"})
    CHECK(kept(where) == std::vector{0});
  check_reasons({{"BAND1 == 1", "several columns for 'BAND1' of --where: Band_1, band1; allowed"},
                 {"band_9 > 0", "no column for 'band_9'"},
                 {"\"band 2 > 0", "is not closed by a quote"}},
                [&](const std::string& where) { return error_of([&] { kept(where); }); });
}

TEST_CASE("a number of a condition is rounded to the type of its column") {
  const ScratchFolder folder;
  const auto file =
      folder.write("a.ply", ascii_ply("1 1 1 0.1\n2 2 2 0.7\n", kXyz + "property float quality\n"));
  const auto kept = [&](const std::string& where) { return read_filtered({file}, {.where = where}).kept; };
  CHECK(kept("quality <= 0.1") == std::vector{0});
  CHECK(kept("quality >= 0.7") == std::vector{1});
  CHECK(kept("quality > 0.1") == std::vector{1});
}

TEST_CASE("a scan without a point is an error that says why") {
  const ScratchFolder folder;
  const auto error = [&](const std::string& text) {
    return error_of([&] { read_filtered({folder.write("a.csv", text)}, {}); });
  };
  CHECK_THAT(error("x,y,z\n"), Contains("a.csv: no points: a header alone"));
  CHECK_THAT(error("x,y,z\nnan,1,2\ninf,1,2\n"), Contains("a.csv: no points: none of 2 rows has a place"));
}

TEST_CASE("rays without return are at 0 0 0 and at the scanner that a PCD or a PLY names, before a pose") {
  const ScratchFolder folder;
  const auto scan = folder.write("a.pcd", ascii_pcd("0 0 0\n1 2 3\n1 2 4\n10 20 30\n", "1 2 3"));
  CHECK(read_filtered({scan}, {}).kept == std::vector{0, 1, 2, 3});
  CHECK(read_filtered({scan}, {.drop_origin = true}).kept == std::vector{2, 3});
  const Pose pose = parse_pose("0.1 0.2 0.3 0 0 0.6 0.8");
  CHECK(read_filtered({{scan, pose}}, {.drop_origin = true}).kept == std::vector{2, 3});
  const auto ply = folder.write("a.ply", ply_header(kCamera + vertices(3)) + "1 2 3\n0 0 0\n1 2 3\n1 2 4\n");
  CHECK(read_filtered({ply}, {.drop_origin = true}).kept == std::vector{2});
}

// ---- Degrees that nothing names

using Positions = std::vector<Eigen::Vector3d>;

double rounded(double value, int digits) {
  return std::round(value * std::pow(10, digits)) / std::pow(10, digits);
}

// Rows of jittered positions with heights, as surveys have them.
Positions survey(const Eigen::Vector2d& corner, double spacing,
                 const std::function<double(double x, double y)>& height) {
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> jitter(-0.3 * spacing, 0.3 * spacing);
  Positions positions;
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 60; ++column) {
      const double x = column * spacing + jitter(draw), y = row * spacing + jitter(draw);
      positions.emplace_back(rounded(corner.x() + x, 7), rounded(corner.y() + y, 7), height(x, y));
    }
  }
  return positions;
}

// A depth of 24 to 26, smooth, in steps of a hundredth.
double shelf(double x, double y) {
  return rounded(-25 + std::sin(20 * x) * std::cos(10 * y), 2);
}

Positions swapped(Positions positions) {
  for (Eigen::Vector3d& position : positions) std::swap(position.x(), position.y());
  return positions;
}

TEST_CASE("degrees of one survey with heights in metres are known by their values") {
  const auto rough = [](double x, double y) {
    return -2600 + 50 * std::sin(5e3 * x) + 20 * std::sin(7e3 * y);
  };
  const auto hills = [](double x, double y) { return 500 + 2 * std::sin(3e4 * x) + std::cos(2e4 * y); };
  for (const Positions& degrees : {survey({187, -18}, 0.003, rough), survey({11.5, 48.1}, 1e-5, hills),
                                   survey({-0.1, 51.5}, 1e-5, hills), survey({4.1, 52.6}, 0.002, shelf)}) {
    CHECK(look_like_degrees(degrees));
    CHECK(look_like_degrees(swapped(degrees)));
  }
}

TEST_CASE("degrees are known in files without a system and a unit") {
  const ScratchFolder folder;
  const std::string rows = Cloud{survey({4.1, 52.6}, 0.002, shelf), {}}.text();
  for (const std::string& file :
       {folder.write("a.xyz", rows), folder.write("a.ply", ascii_ply(rows, kXyz))}) {
    INFO(file);
    const ScanFiles scan({file}, {});
    CHECK(scan.files()[0].may_be_degrees);
    CHECK_FALSE(scan.files()[0].is_geographic);  // no more than a guess
  }
}

TEST_CASE("scans in lengths do not look like degrees, in any order of their points") {
  const auto ground = [](double x, double y) { return rounded(3 * std::sin(x / 2) + std::cos(y), 3); };
  const auto steep = [](double x, double) { return 60 * x; };
  std::vector<Positions> all = {survey({0, 0}, 0.1, ground), survey({30, 40}, 0.04, ground),
                                survey({0, 0}, 0.1, steep), survey({30, 40}, 0.01, steep)};
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, 0.002);
  Positions wall, pole, sphere, stairs, cliff, frame;
  for (int i = 0; i < 4096; ++i) {
    wall.emplace_back(5 + noise(draw), i / 200 * 0.02, share(draw) * 4);
    const double turn = 2 * std::numbers::pi * share(draw), z = 2 * share(draw) - 1, r = std::sqrt(1 - z * z);
    pole.emplace_back(rounded(30 + 0.05 * std::cos(turn), 3), rounded(40 + 0.05 * std::sin(turn), 3), 10 * z);
    sphere.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    const double x = 5 * share(draw);
    stairs.emplace_back(x, share(draw), rounded(x, 0));
    cliff.emplace_back(40 * share(draw), 3 * share(draw), 45 * share(draw));
    const double depth = rounded(2 + share(draw), 2);  // of a camera, in whole centimetres
    frame.emplace_back(depth * (share(draw) - 0.5), depth * (share(draw) - 0.5), depth);
  }
  for (const Positions& positions : {wall, pole, sphere, stairs, cliff, frame}) all.push_back(positions);
  for (Positions& lengths : all) {
    CHECK_FALSE(look_like_degrees(lengths));
    CHECK_FALSE(look_like_degrees(swapped(lengths)));
    std::shuffle(lengths.begin(), lengths.end(), draw);
    CHECK_FALSE(look_like_degrees(lengths));
  }
}

}  // namespace
}  // namespace lacuna::test
