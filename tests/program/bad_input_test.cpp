// SPDX-License-Identifier: Apache-2.0
// Whatever the input and the disk: a result where one exists, else one clear line and exit code 1, nothing
// half-written.
#include "tests/support/clouds.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/system.hpp"
#include "tests/support/test.hpp"

#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::test {
namespace {

// In single precision.
std::string ply(const Cloud& cloud) {
  return ascii_ply(cloud.text());
}

ProgramResult detect_quietly(const std::string& scan, const fs::path& out, const Words& more = {}) {
  return run_program(with({"detect", scan, "--out", out.string(), "--quiet"}, more));
}

TEST_CASE("a scan that is cut, missing, empty or of an absurd count ends each command with one line") {
  const ScratchFolder scratch;
  const fs::path out = scratch / "a/b/out";
  const std::string whole = ply(plane(10));
  fs::create_directory(scratch / "nothing");
  for (const std::string& scan :
       {(scratch / "none.ply").string(), (scratch / "nothing").string(), scratch.write("empty.ply", ""),
        scratch.write("cut.ply", whole.substr(0, whole.size() - 9)),
        scratch.write("absurd.ply", ply_header("element vertex 18446744073709551615\n" + kXyz) + "1 2 3\n"),
        scratch.write("nan.ply", ply({std::vector(40, Eigen::Vector3d(NAN, INFINITY, 0)), {}}))}) {
    INFO(scan);
    check_failure(detect_quietly(scan, out), 1, scan);
    check_failure(run_program({"info", scan}), 1, scan);
    CHECK_FALSE(fs::exists(scratch / "a"));
  }
}

TEST_CASE("what is odd about a scan is a warning that names it, and the run goes on") {
  const ScratchFolder scratch;
  const auto warnings = [&](const Words& scans) {
    const ProgramResult result =
        run_program(with(with({"detect"}, scans), {"--out", (scratch / "out").string(), "--quiet"}));
    CHECK(result.exit_code == 0);
    return result.err;
  };
  const std::string even = scratch.write("even.ply", ply(plane(20)));
  const Cloud utm = plane(40).scaled(0.5).translated({500'000, 5'400'000, 300});
  CHECK(warnings({even}).empty());
  CHECK_THAT(warnings({even, (scratch.path() / "." / "even.ply").string()}),
             Contains("even.ply: given more than once"));
  CHECK_THAT(warnings({scratch.write("few.txt", "0 0 0\n1 0 0\n0 1 0\n")}), Contains("3 distinct points"));
  CHECK_THAT(warnings({scratch.write("utm.ply", ply(utm))}), Contains("coordinates are in steps of 0.5"));
}

TEST_CASE("few points, equal points and collinear ones have results") {
  const ScratchFolder scratch;
  const std::vector<std::pair<Cloud, std::size_t>> scans = {
      {line(1), 0},          {line(2), 0},  {scattered(15, 1), 0}, {scattered(16, 1), 0},
      {coincident(3000), 0}, {line(99), 0}, {plane(12), 0},        {plane(12).with_unusable(20, 1), 1}};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const fs::path out = scratch / std::to_string(i);
    const std::string file = scratch.write("scan.ply", ply(scans[i].first));
    const ProgramResult result = detect_quietly(
        file, out,
        {"--points", "--points-normals", "--orient-normals", "--tile-points", "1", "--threads", "3"});
    INFO("scan " << i << ": " << result.err);
    REQUIRE(result.exit_code == 0);
    CHECK(read_json(out / "holes.json").at("counts").at("points") == scans[i].first.size());
    CHECK(read_json(out / "holes.json").at("counts").at("dropped") >= scans[i].second);
    CHECK(count_entries(out) == 7);
  }
}

// Another user, as which files can be out of reach even when the tests run as root.
ProgramResult run_as_nobody(const Words& arguments) {
  const Words program = with({LACUNA_PROGRAM}, arguments);
  if (geteuid() != 0) return run_command(program);
  return run_command(with({"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"}, program));
}

TEST_CASE("without permission to read or to write there is one line that names the place") {
  const ScratchFolder scratch;
  const fs::path root = scratch / "open";
  fs::create_directory(root);
  ::chmod((scratch / "").c_str(), 0755);
  ::chmod(root.c_str(), 0777);
  const std::string scan = scratch.write("open/scan.ply", ply(plane(12)));
  const std::string locked = (root / "locked").string(), other = (root / "other").string();
  const auto detect = [&](const std::string& out, const Words& more = {}) {
    return run_as_nobody(with({"detect", scan, "--out", out, "--quiet"}, more));
  };
  if (run_as_nobody({"--version"}).exit_code != 0) return skip("cannot run the program as another user");
  REQUIRE(detect((root / "out").string()).exit_code == 0);

  fs::create_directory(locked);
  ::chmod(locked.c_str(), 0555);
  check_failure(detect(locked), 1, "locked");
  check_failure(detect(locked + "/new"), 1, "locked");
  check_failure(detect(other, {"--scratch", locked}), 1, "locked");
  CHECK(fs::is_empty(locked));

  ::chmod(scan.c_str(), 0000);
  check_failure(detect(other), 1, "scan.ply");
  check_failure(run_as_nobody({"info", scan}), 1, "scan.ply");
  CHECK_FALSE(fs::exists(other));
  ::chmod(scan.c_str(), 0644);
}

TEST_CASE("a disk that is too small for a GeoPackage ends the check of an area with one short line") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", plane(40).punched({20, 20}, 5).text());
  const std::string area =
      scratch.write("area.json", R"({"type":"Polygon","coordinates":[[[2,2],[38,2],[38,38],[2,38],[2,2]]]})");
  std::size_t failed = 0;
  for (int kib = 16; kib <= 128; kib += 16) {
    const SmallDisk disk(scratch / "disk", std::to_string(kib) + "k");
    if (!disk.mounted()) return skip("cannot mount a small disk");
    const ProgramResult result = run_program({"check", scan, "--area", area, "--void-rule", "4", "--out",
                                              (disk.path() / "out").string(), "--quiet"});
    CHECK(result.exit_code == 1);  // the scan has a void
    const std::size_t error = result.err.rfind("lacuna: error: ");
    CHECK(result.err.size() - error < 300 + disk.path().string().size());
    failed += result.err.find("full") != result.err.npos ? 1 : 0;
  }
  CHECK(failed >= 3);
}

TEST_CASE("a disk that is full, in whatever phase, ends the run with one line and leaves nothing behind") {
  const ScratchFolder scratch;
  const Cloud cloud = plane(120).punched({60, 60}, 8).jittered(0.2, 1);
  const std::string scan = scratch.write("scan.ply", ply(cloud));
  std::size_t failed = 0, done = 0;
  for (const std::string size :
       {"8k", "64k", "256k", "512k", "1m", "1536k", "2m", "2560k", "3m", "4m", "64m"}) {
    const SmallDisk disk(scratch / "disk", size);
    if (!disk.mounted()) return skip("cannot mount a small disk");
    INFO("workspace on a disk of " << size);
    const fs::path out = scratch / ("out " + size);
    const ProgramResult result =
        detect_quietly(scan, out,
                       {"--scratch", disk.path().string(), "--points", "--points-normals", "--orient-normals",
                        "--tile-points", "500", "--memory-limit", "64MiB"});
    CHECK(fs::is_empty(disk.path()));
    if (result.exit_code == 0) {
      ++done;
      CHECK(count_entries(out) == 7);
      continue;
    }
    ++failed;
    check_failure(result, 1, disk.path().string());
    CHECK_THAT(result.err, Contains("No space left on device") || Contains("the run needs at least"));
    CHECK_FALSE(fs::exists(out));
  }
  CHECK(failed >= 3);
  CHECK(done >= 1);

  failed = 0;
  for (const std::string size : {"4k", "16k", "64k", "128k", "256k", "512k"}) {
    const SmallDisk disk(scratch / "disk", size);
    INFO("results on a disk of " << size);
    const ProgramResult result =
        detect_quietly(scan, disk.path() / "out",
                       {"--scratch", (scratch / "").string(), "--points", "--tile-points", "500"});
    if (result.exit_code == 0) continue;
    ++failed;
    check_failure(result, 1, disk.path().string());
    CHECK(fs::is_empty(disk.path()));
  }
  CHECK(failed >= 3);
}

TEST_CASE("a disk that cannot hold the points is said once they are counted, before any is stored") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.ply", ply(plane(300).jittered(0.2, 1)));
  const SmallDisk disk(scratch / "disk", "1m");  // 90,000 points take 1.4 MiB
  if (!disk.mounted()) return skip("cannot mount a small disk");
  const fs::path out = scratch / "out";
  // A filter may leave points out, so the headers alone do not say how many there are.
  const ProgramResult result =
      detect_quietly(scan, out, {"--scratch", disk.path().string(), "--drop-origin"});
  check_failure(result, 1, "the run needs at least 1.4 MiB; --scratch names a folder on another one");
  CHECK(fs::is_empty(disk.path()));
  CHECK_FALSE(fs::exists(out));
}

TEST_CASE("the disk that info names is enough for the run, and less than its least is not") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.ply", ply(plane(300).punched({150, 150}, 8).jittered(0.2, 1)));
  const auto needs = json_of(run_program({"info", scan, "--json"}).out).at("temporary_bytes");
  const auto runs_on = [&](double bytes, const Words& options) {
    const SmallDisk disk(scratch / "disk", std::to_string(static_cast<std::uint64_t>(bytes)));
    const Words more = with({"--memory-limit", "64MiB", "--scratch", disk.path().string()}, options);
    return disk.mounted() && detect_quietly(scan, scratch / "out", more).exit_code == 0;
  };
  if (!SmallDisk(scratch / "disk", "1m").mounted()) return skip("cannot mount a small disk");
  const auto least = needs.at("least").get<double>(), most = needs.at("most").get<double>();
  CHECK(runs_on(most, {}));
  CHECK(runs_on(most, {"--points", "--orient-normals", "--tile-points", "500"}));
  CHECK_FALSE(runs_on(0.9 * least, {}));
}

}  // namespace
}  // namespace lacuna::test
