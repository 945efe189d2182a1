// SPDX-License-Identifier: Apache-2.0
// What comes back as it was: points in either precision, a scan, parts of a workspace; and temporary folders,
// which go.
#include "engine/store/kept_scan.hpp"
#include "engine/store/point_column.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/store/temporary_folder.hpp"
#include "engine/survey/survey.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/system.hpp"

#include <future>

#include <sys/wait.h>
#include <unistd.h>

namespace lacuna {
namespace {

// ---- Points on disk

SurveyedScan surveyed(const PointBatch& batch) {
  const ScratchFolder folder;
  Survey survey(1 << 20, batch.size(), folder / "cells");
  survey.add(batch);
  return survey.finish();
}

TEST_CASE("what single precision would lose is not written in it") {
  const ScratchFolder folder;
  PointColumn column(StoreFile(folder / "points"), Precision::kSingle);
  const ScanPoint good{0.5, -3, 1e30f, PointId{7}};
  CHECK_NOTHROW(column.write(0, std::vector{good}));
  for (const ScanPoint& bad :
       {ScanPoint{0.1, 0, 0, PointId{7}}, ScanPoint{0, 1e300, 0, PointId{7}},
        ScanPoint{0, 0, 1 + 1e-9, PointId{7}}, ScanPoint{0, 0, 0, PointId{std::uint64_t{1} << 32}}})
    CHECK_THROWS_AS(column.write(0, std::vector{good, bad}), Error);
}

TEST_CASE("a scan is of single precision if all of its finite coordinates are") {
  PointBatch batch{.positions = {{0.5, 1, 2}, {-0.0, 3, 1e-3f}, {NAN, 0.1, 0}, {0.1, INFINITY, 0}}};
  CHECK(surveyed(batch).precision() == Precision::kSingle);
  batch.positions.emplace_back(0.1, 0, 0);
  CHECK(surveyed(batch).precision() == Precision::kDouble);
  CHECK(SurveyTotals{.ids = (std::uint64_t{1} << 32) + 1}.precision() == Precision::kDouble);
}

// ---- A scan

// Counts what is read of it.
class CountedScan final : public PointSource {
 public:
  explicit CountedScan(const Cloud& cloud) : scan_(cloud) {}

  void rewind() override { scan_.rewind(); }
  bool next(PointBatch& batch) override {
    const bool has_more = scan_.next(batch);
    points_read += batch.size();
    return has_more;
  }
  std::optional<std::uint64_t> expected_points() const override { return scan_.expected_points(); }
  bool has_normals() const override { return scan_.has_normals(); }

  std::size_t points_read = 0;

 private:
  MemoryScan scan_;
};

bool is_same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0;  // NaN is NaN
}

void check_kept(const Cloud& cloud) {
  const ScratchFolder folder;
  CountedScan scan(cloud);
  KeptScan kept(scan, folder / "input");
  PointBatch batch;
  kept.next(batch);  // a pass that is given up
  for (int pass = 0; pass < 3; ++pass) {
    scan.points_read = 0;
    kept.rewind();
    const Cloud all = read_points(kept);
    CHECK(scan.points_read == (pass == 0 ? cloud.size() : 0));
    CHECK(std::equal(all.positions.begin(), all.positions.end(), cloud.positions.begin(),
                     cloud.positions.end(), is_same));
    CHECK(std::equal(all.normals.begin(), all.normals.end(), cloud.normals.begin(), cloud.normals.end(),
                     is_same));
  }
}

TEST_CASE("a scan that is kept is read once, and each pass has the same points") {
  check_kept(scattered(200'000, 1));
  check_kept(plane(40).with_unusable(20, 2).with_random_normals(3));
  check_kept({});
}

// ---- Parts: what is read of one is what was written, or there is no such part

using Numbers = std::vector<std::uint64_t>;

constexpr std::string_view kMadeFrom = "this input";

Numbers counted(std::size_t count, std::uint64_t first) {
  Numbers numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

void add(PartWriter& part, const char* stream, std::uint64_t key, const Numbers& numbers) {
  part.add(stream, key, std::span<const std::uint64_t>(numbers));
}

// Two streams and three keys.
fs::path sealed(const ScratchFolder& folder, std::size_t count = 5) {
  PartWriter part(folder / "part");
  add(part, "a", 7, counted(count, 0));
  add(part, "b", 7, {});
  add(part, "a", 2, counted(count, 100));
  add(part, "b", 300, counted(3, 200));
  add(part, "a", 7, counted(2, 300));
  part.seal(kMadeFrom);
  return folder / "part";
}

TEST_CASE("a part gives back its entries by stream and key, in their order") {
  for (const std::size_t count : {0, 5, 400'000}) {  // the last is more than a block
    const ScratchFolder folder;
    const std::optional<PartReader> part = PartReader::open(sealed(folder, count), kMadeFrom);
    REQUIRE(part);
    CHECK(part->keys() == Numbers{2, 7, 300});
    CHECK(part->streams(7) == std::vector<std::string>{"a", "b"});
    Numbers both = counted(count, 0);
    both.push_back(300);
    both.push_back(301);
    CHECK(part->records<std::uint64_t>("a", 7) == both);
    CHECK(part->records<std::uint64_t>("a", 2) == counted(count, 100));
    CHECK(part->records<std::uint64_t>("b", 300) == counted(3, 200));
    CHECK(part->records<std::uint64_t>("b", 7).empty());
    CHECK(part->records<std::uint64_t>("c", 7).empty());
    CHECK(part->records<std::uint64_t>("a", 8).empty());
    CHECK(part->size("a", 7) == (count + 2) * sizeof(std::uint64_t));
    Numbers read(count + 2);
    part->read("a", 7, std::as_writable_bytes(std::span(read)));
    CHECK(read == both);
    CHECK(part->size("c", 7) == 0);
    CHECK(folder.names() == std::vector<std::string>{"part"});
  }
}

TEST_CASE("a stream of other records than are read is damaged") {
  const ScratchFolder folder;
  struct Three {
    std::uint64_t values[3];
  };
  const std::optional<PartReader> part = PartReader::open(sealed(folder), kMadeFrom);
  CHECK_THROWS_AS(part->records<Three>("a", 2), DamagedFile);
  CHECK_THROWS_AS(part->record<std::uint64_t>("missing"), DamagedFile);
}

TEST_CASE("a part that was not sealed leaves nothing, and is in nobody's way") {
  const ScratchFolder folder;
  {
    PartWriter part(folder / "part");
    add(part, "a", 1, counted(300'000, 0));
  }
  CHECK(folder.names().empty());
  CHECK_FALSE(PartReader::open(folder / "part", kMadeFrom));
  sealed(folder);
  CHECK(PartReader::open(folder / "part", kMadeFrom));
}

TEST_CASE("what is made from something else, or is no part, is none") {
  const ScratchFolder folder;
  const fs::path part = sealed(folder);
  CHECK_FALSE(PartReader::open(part, "another input"));
  CHECK(PartReader::is_part(part));
  fs::create_directory(folder / "folder");
  fs::create_symlink(part, folder / "link");
  folder.write("empty", "");
  folder.write("text", std::string(1000, 'x'));
  for (const char* name : {"folder", "link", "empty", "text", "missing"}) {
    INFO(name);
    CHECK_FALSE(PartReader::open(folder / name, kMadeFrom));
    CHECK_FALSE(PartReader::is_part(folder / name));
  }
}

TEST_CASE("a part that is cut at any length is none") {
  const ScratchFolder folder;
  const fs::path part = sealed(folder);
  const std::string whole = test::read_file(part);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    folder.write("part", std::string_view(whole).substr(0, length));
    if (PartReader::open(part, kMadeFrom)) FAIL_CHECK("cut to " << length << " bytes");
  }
  folder.write("part", whole + "x");
  CHECK_FALSE(PartReader::open(part, kMadeFrom));
}

TEST_CASE("a part with any bit flipped is none, or the entry with that bit cannot be read") {
  const ScratchFolder folder;
  const fs::path path = sealed(folder);
  const std::string whole = test::read_file(path);
  std::size_t damaged_entries = 0;
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    std::string damaged = whole;
    damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << (byte % 8)));
    folder.write("part", damaged);
    const std::optional<PartReader> part = PartReader::open(path, kMadeFrom);
    if (!part) continue;
    ++damaged_entries;
    std::size_t found = !part->made_from();
    for (const std::uint64_t key : part->keys()) {
      for (const std::string& stream : part->streams(key)) {
        try {
          part->records<std::uint64_t>(stream, key);
        } catch (const DamagedFile& error) {
          ++found;
          CHECK(error.file() == path);
        }
      }
    }
    INFO("byte " << byte);
    CHECK(found == 1);
  }
  CHECK(damaged_entries == 15 * sizeof(std::uint64_t) + kMadeFrom.size());
}

}  // namespace
}  // namespace lacuna

namespace lacuna::test {

// ---- Temporary folders

TEST_CASE("a temporary folder goes with all that it holds, and no link is followed", "[io]") {
  const ScratchFolder folder;
  const std::string file = folder.write("file", "x");
  {
    const TemporaryFolder gone(folder.path(), ".t-");
    fs::create_directories(gone.path() / "sub/deeper");
    folder.write(gone.path().filename() / "sub/deeper/file", "");
    fs::create_directory_symlink(folder.path(), gone.path() / "sub/link");
    CHECK(folder.names().size() == 2);
  }
  CHECK(folder.names() == Names{"file"});
  CHECK(error_of([&] { TemporaryFolder(folder / "none", ".t-"); }) ==
        (folder / "none").string() + ": cannot make a temporary folder: No such file or directory");
}

TEST_CASE("what a killed process has left goes, with its mark alone, and nothing else of its name", "[io]") {
  const ScratchFolder folder;
  const auto left = [&] {
    do_apart([&] {
      const TemporaryFolder made(folder.path(), ".t-");
      std::ofstream(made.path() / "file") << "x";
      std::raise(SIGKILL);
    });
    return folder.names();
  };
  const std::string name = left().at(0);
  std::vector<fs::path> rescued;
  CHECK(
      remove_leftovers(folder.path(), ".t-", [&](const fs::path& from) { rescued.push_back(from); }).empty());
  CHECK(rescued == std::vector{folder / name});
  CHECK(folder.names().empty());

  const std::string digits = ".t-0123456789abcde";
  fs::rename(folder / left().at(0), folder / "moved");
  fs::create_directory_symlink(folder / "moved", folder / (digits + "0"));
  fs::copy(folder / "moved", folder / (digits + "1"), fs::copy_options::recursive);
  fs::create_directory(folder / (digits + "2"));
  folder.write(digits + "2/file", "mine");
  fs::permissions(folder / (digits + "2"), fs::perms::sticky_bit, fs::perm_options::add);
  fs::create_directory(folder / (digits + "3"));
  folder.write(digits + "4", "mine");
  const Names before = folder.names();
  const TemporaryFolder own(folder.path(), ".t-");
  CHECK(remove_leftovers(folder.path(), ".t-") == std::vector{own.path()});
  Names after = folder.names();
  std::erase(after, own.path().filename());
  CHECK(after == before);
  CHECK(fs::exists(folder / "moved/file"));
  CHECK(fs::exists(folder / (digits + "2") / "file"));

  // Before the mark and after it, a folder is empty, and sticky.
  fs::remove(folder / (digits + "2") / "file");
  remove_leftovers(folder.path(), ".t-");
  CHECK_FALSE(fs::exists(folder / (digits + "2")));
}

TEST_CASE("before a process ends by a signal its temporary folders go, once nothing is half done", "[io]") {
  const ScratchFolder folder;
  const pid_t child = fork();  // what it removes is gone for good, and it can make no folder any more
  if (child == 0) {
    const TemporaryFolder gone(folder.path(), ".t-");
    std::optional<RemovalPause> pause(std::in_place);
    const auto removal = std::async(std::launch::async, remove_temporary_folders);
    const bool waits = removal.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout;
    const bool stays = fs::exists(gone.path());
    pause.reset();
    removal.wait();
    _exit(waits && stays && !fs::exists(gone.path()) ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  CHECK(folder.names().empty());
}

}  // namespace lacuna::test
