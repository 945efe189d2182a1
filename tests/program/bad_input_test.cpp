// SPDX-License-Identifier: Apache-2.0
// Whatever the input and the disk: a result where one exists, else one clear line and exit code 1, nothing
// half-written.
#include "engine/pipeline.hpp"
#include "engine/run/error.hpp"
#include "io/scan/file_scan.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/small_disk.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna {
using namespace io;

namespace {

namespace fs = std::filesystem;
using test::check_failure;
using test::count_entries;
using test::ProgramResult;
using test::run_program;
using test::ScratchFolder;
using test::SmallDisk;

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string header(const std::string& count, const std::string& format = "binary_little_endian") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + count +
         "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
}

std::string binary_ply(const Cloud& cloud) {
  std::string bytes = header(std::to_string(cloud.size()));
  for (const Eigen::Vector3d& p : cloud.positions) {
    for (const double coordinate : p) put(bytes, static_cast<float>(coordinate));
  }
  return bytes;
}

ProgramResult detect_quietly(const std::string& scan, const fs::path& out,
                             std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"detect", scan, "--out", out.string(), "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

TEST_CASE("a scan cut at any byte is an error of the engine, and leaves an empty workspace") {
  const ScratchFolder scratch;
  const std::string whole = binary_ply(plane(4));
  const fs::path workspace = scratch / "workspace";
  fs::create_directory(workspace);
  NoProgress quiet;
  std::size_t refused = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string file = scratch.write("cut.ply", whole.substr(0, length));
    try {
      FileScan scan({file}, {});
      detect(scan, {}, workspace, quiet);
      FAIL_CHECK("cut at byte " << length << ": no error");
    } catch (const Error&) {
      ++refused;
    }
    if (count_entries(workspace) != 0) FAIL_CHECK("cut at byte " << length << ": the workspace is not empty");
  }
  CHECK(refused == whole.size());
  FileScan scan({scratch.write("whole.ply", whole)}, {});
  CHECK(run_engine(scan, {}).summary.counts.points == 16);
}

TEST_CASE("a scan cut at some bytes, wrong and absurd counts end the program with one line") {
  const ScratchFolder scratch;
  const std::string whole = binary_ply(plane(10));
  const fs::path out = scratch / "out";
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{40}, header("100").size() - 1,
                                   header("100").size(), header("100").size() + 7, whole.size() - 1}) {
    INFO("cut at " << length);
    check_failure(detect_quietly(scratch.write("cut.ply", whole.substr(0, length)), out), 1, "cut.ply");
    CHECK_FALSE(fs::exists(out));
  }
  for (const std::string count :
       {"101", "1000000000000000000", "18446744073709551615", "18446744073709551616", "-1"}) {
    for (const std::string format : {"binary_little_endian", "binary_big_endian", "ascii"}) {
      INFO(count << " vertices, " << format);
      const std::string body = format == "ascii" ? "1 2 3\n4 5 6\n" : whole.substr(header("100").size());
      check_failure(detect_quietly(scratch.write("absurd.ply", header(count, format) + body), out), 1,
                    "absurd.ply");
      check_failure(run_program({"info", scratch.write("absurd.ply", header(count, format) + body)}), 1,
                    "absurd.ply");
      CHECK_FALSE(fs::exists(out));
    }
  }
  check_failure(
      detect_quietly(scratch.write("more.ply", header("99") + whole.substr(header("100").size())), out), 1,
      "more.ply");
}

TEST_CASE("a scan without points is an error that says why, and no result") {
  const ScratchFolder scratch;
  for (const std::string format : {"binary_little_endian", "ascii"})
    check_failure(detect_quietly(scratch.write("none.ply", header("0", format)), scratch / format), 1,
                  "none.ply: no points: a header alone");
  const double nan = std::nan("");
  const std::string unusable =
      scratch.write("nan.ply", binary_ply({std::vector(40, Eigen::Vector3d(nan, INFINITY, -INFINITY)), {}}));
  check_failure(detect_quietly(unusable, scratch / "out"), 1, "nan.ply: no points: none of 40 rows");
  check_failure(run_program({"info", unusable}), 1, "nan.ply: no points: none of 40 rows");
}

TEST_CASE("what is odd about a scan is a warning that names it, and the run goes on") {
  const ScratchFolder scratch;
  const auto warnings = [&](std::vector<std::string> scans) {
    scans.insert(scans.begin(), "detect");
    scans.insert(scans.end(), {"--out", (scratch / "out").string(), "--quiet"});
    const ProgramResult result = run_program(scans);
    CHECK(result.exit_code == 0);
    return result.err;
  };
  const std::string even = scratch.write("even.ply", binary_ply(plane(20)));
  CHECK(warnings({even}).empty());
  CHECK_THAT(warnings({even, (scratch.path() / "." / "even.ply").string()}),
             Catch::Matchers::Contains("even.ply: given more than once"));
  CHECK_THAT(warnings({scratch.write("few.txt", "0 0 0\n1 0 0\n0 1 0\n")}),
             Catch::Matchers::Contains("3 distinct points; each needs k = 15 neighbours"));
  const std::string utm =
      scratch.write("utm.ply", binary_ply(plane(40).scaled(0.5).translated({500'000, 5'400'000, 300})));
  CHECK_THAT(warnings({utm}), Catch::Matchers::Contains("steps of up to 0.5 here"));
}

TEST_CASE("few points, equal points and collinear ones have results") {
  const ScratchFolder scratch;
  const std::vector<std::pair<Cloud, std::size_t>> scans = {
      {line(1), 0},          {line(2), 0},  {scattered(15, 1), 0}, {scattered(16, 1), 0},
      {coincident(3000), 0}, {line(99), 0}, {plane(12), 0},        {plane(12).with_unusable(20, 1), 1}};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const fs::path out = scratch / std::to_string(i);
    const std::string file = scratch.write("scan.ply", binary_ply(scans[i].first));
    for (const std::string tile_points : {"1", "1000"}) {
      const ProgramResult result = detect_quietly(file, out,
                                                  {"--points", "--points-normals", "--orient-normals",
                                                   "--tile-points", tile_points, "--threads", "3"});
      INFO("scan " << i << ": " << result.err);
      REQUIRE(result.exit_code == 0);
      CHECK(test::read_json(out / "holes.json").at("counts").at("points") == scans[i].first.size());
      CHECK(test::read_json(out / "holes.json").at("counts").at("dropped") >= scans[i].second);
      CHECK(count_entries(out) == 7);
    }
  }
}

TEST_CASE("points whose squared distances overflow or vanish end the program with one line") {
  const ScratchFolder scratch;
  const fs::path out = scratch / "out";
  check_failure(detect_quietly(scratch.write("far.txt", "0 0 0\n1 0 0\n1e200 0 0\n"), out), 1, "1e153");
  check_failure(detect_quietly(scratch.write("far.txt", "0 0 0\n1 0 0\n1e200 0 0\n"), out), 1,
                "far.txt: point 2 lies at 1e+200 ");
  check_failure(detect_quietly(scratch.write("near.txt", "0 0 0\n1e-200 0 0\n1 0 0\n"), out), 1, "underflow");
  CHECK_FALSE(fs::exists(out));
}

// Another user, as which files can be out of reach even when the tests run as root.
std::vector<std::string> as_nobody(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), LACUNA_PROGRAM);
  if (geteuid() == 0) {
    arguments.insert(arguments.begin(), {"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
  }
  return arguments;
}

TEST_CASE("without permission to read or to write there is one line that names the place") {
  const ScratchFolder scratch;
  const fs::path root = scratch / "open";
  fs::create_directory(root);
  ::chmod((scratch / "").c_str(), 0755);
  ::chmod(root.c_str(), 0777);
  const std::string scan = scratch.write("open/scan.ply", binary_ply(plane(12)));
  const std::string out = (root / "out").string();
  if (test::run_command(as_nobody({"--version"})).exit_code != 0) {
    test::skip("cannot run the program as another user");
    return;
  }
  REQUIRE(test::run_command(as_nobody({"detect", scan, "--out", out, "--quiet"})).exit_code == 0);

  const std::string locked = (root / "locked").string();
  fs::create_directory(locked);
  ::chmod(locked.c_str(), 0555);
  check_failure(test::run_command(as_nobody({"detect", scan, "--out", locked, "--quiet"})), 1, "locked");
  check_failure(test::run_command(as_nobody({"detect", scan, "--out", locked + "/new", "--quiet"})), 1,
                "locked");
  check_failure(test::run_command(as_nobody(
                    {"detect", scan, "--out", (root / "other").string(), "--scratch", locked, "--quiet"})),
                1, "locked");
  CHECK(fs::is_empty(locked));
  CHECK_FALSE(fs::exists(root / "other"));

  ::chmod(scan.c_str(), 0000);
  check_failure(test::run_command(as_nobody({"detect", scan, "--out", (root / "other").string(), "--quiet"})),
                1, "scan.ply");
  check_failure(test::run_command(as_nobody({"info", scan})), 1, "scan.ply");
  CHECK_FALSE(fs::exists(root / "other"));
  ::chmod(scan.c_str(), 0644);
}

TEST_CASE("a disk that is too small for a GeoPackage ends the check of an area with one short line") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", plane(40).punched({20, 20}, 5).text());
  const std::string area =
      scratch.write("area.json", R"({"type":"Polygon","coordinates":[[[2,2],[38,2],[38,38],[2,38],[2,2]]]})");
  std::size_t failed = 0;
  for (int kib = 16; kib <= 128; kib += 8) {
    const SmallDisk disk(scratch / "disk", std::to_string(kib) + "k");
    if (!disk.mounted()) {
      test::skip("cannot mount a small disk");
      return;
    }
    const ProgramResult result = run_program({"check", scan, "--area", area, "--void-size", "4", "--out",
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
  const std::string scan = scratch.write("scan.ply", binary_ply(cloud));
  std::size_t failed = 0, done = 0;
  for (const std::string size :
       {"8k", "64k", "256k", "512k", "1m", "1536k", "2m", "2560k", "3m", "4m", "64m"}) {
    const SmallDisk disk(scratch / "disk", size);
    if (!disk.mounted()) {
      test::skip("cannot mount a small disk");
      return;
    }
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
    CHECK_THAT(result.err, Catch::Matchers::Contains("No space left on device") ||
                               Catch::Matchers::Contains("the run needs at least"));
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
  const std::string scan = scratch.write("scan.ply", binary_ply(plane(300).jittered(0.2, 1)));
  const SmallDisk disk(scratch / "disk", "1m");  // 90,000 points take 1.4 MiB
  if (!disk.mounted()) {
    test::skip("cannot mount a small disk");
    return;
  }
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
  const std::string scan =
      scratch.write("scan.ply", binary_ply(plane(300).punched({150, 150}, 8).jittered(0.2, 1)));
  const auto needs = nlohmann::json::parse(run_program({"info", scan, "--json"}).out).at("temporary_bytes");
  const auto runs_on = [&](double bytes, const std::vector<std::string>& options) {
    const SmallDisk disk(scratch / "disk", std::to_string(static_cast<std::uint64_t>(bytes)));
    std::vector<std::string> more = {"--memory-limit", "64MiB", "--scratch", disk.path().string()};
    more.insert(more.end(), options.begin(), options.end());
    return disk.mounted() && detect_quietly(scan, scratch / "out", more).exit_code == 0;
  };
  if (!SmallDisk(scratch / "disk", "1m").mounted()) {
    test::skip("cannot mount a small disk");
    return;
  }
  const auto least = needs.at("least").get<double>(), most = needs.at("most").get<double>();
  CHECK(runs_on(most, {}));
  CHECK(runs_on(most, {"--points", "--orient-normals", "--tile-points", "500"}));
  CHECK_FALSE(runs_on(0.9 * least, {}));
}

}  // namespace
}  // namespace lacuna
