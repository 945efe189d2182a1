// SPDX-License-Identifier: Apache-2.0
#include "tools/run/disk_check.hpp"

#include "engine/run/error.hpp"
#include "io/results/result_bytes.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/run/run_costs.hpp"

#include <filesystem>
#include <map>

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace io;
using namespace tools;

namespace {

using Catch::Matchers::Contains;

constexpr std::uint64_t kPoints = 10'000, kPlenty = 1 << 30;

std::string header_of(std::uint64_t points) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
}

// A scan of 120,000 bytes.
std::string ply() {
  return header_of(kPoints) + std::string(kPoints * 12, '\1');
}

io::FilesConfig with_limit() {
  io::FilesConfig config;
  config.run.memory_limit = 256 << 20;
  config.run.threads = 1;
  return config;
}

struct Disks {
  std::map<std::string, Disk> of;

  std::optional<Disk> operator()(const std::filesystem::path& folder) const { return of.at(folder.string()); }
};

std::uint64_t workspace_bytes(const FileScan& scan, const io::FilesConfig& config) {
  return run_costs(scan, config, kPoints, kPoints).disk;
}

}  // namespace

TEST_CASE("a disk that is too small for the workspace or for the results is a warning that names it") {
  const ScratchFolder folder;
  const FileScan scan({folder.write("scan.ply", ply())}, {});
  const io::FilesConfig config = with_limit();
  const std::uint64_t workspace = workspace_bytes(scan, config);
  const std::uint64_t results = result_bytes(scan, config, kPoints, kPoints).all();
  CHECK(workspace > kPoints * (16 + 48));
  CHECK(results == kPoints * 32);

  const auto check = [&](std::uint64_t free_of_workspace, std::uint64_t free_of_results) {
    return check_disks(scan, config, "ws", "out",
                       Disks{{{"ws", {1, free_of_workspace}}, {"out", {2, free_of_results}}}});
  };
  CHECK(check(workspace, results).empty());
  const std::vector<std::string> warnings = check(workspace - 1, results - 1);
  REQUIRE(warnings.size() == 2);
  CHECK_THAT(warnings[0], Contains("ws: ") && Contains("are free on this disk, and the run needs about ") &&
                              Contains("--scratch names a folder on another one"));
  CHECK_THAT(warnings[1], Contains("out: ") && Contains("the run needs about 312 KiB; --out names"));
}

TEST_CASE("workspace and results on one disk need space for both") {
  const ScratchFolder folder;
  const FileScan scan({folder.write("scan.ply", ply())}, {});
  io::FilesConfig config = with_limit();
  config.results.points = true;
  config.output.points_normals = true;
  const std::uint64_t workspace = workspace_bytes(scan, config);
  const std::uint64_t results = result_bytes(scan, config, kPoints, kPoints).all();
  const std::uint64_t larger = std::max(workspace, results);
  const auto check = [&](std::uint64_t number_of_results) {
    return check_disks(scan, config, "ws", "out",
                       Disks{{{"ws", {1, larger}}, {"out", {number_of_results, larger}}}});
  };
  CHECK(check(2).empty());
  CHECK(check(1).size() == 1);
}

TEST_CASE("a disk that cannot hold the annotated scan is an error before the run") {
  const ScratchFolder folder;
  const FileScan scan({folder.write("scan.ply", ply())}, {});
  io::FilesConfig config = with_limit();
  config.results.points = true;
  const std::uint64_t points = result_bytes(scan, config, kPoints, kPoints).points;
  const auto check = [&](std::uint64_t free) {
    return check_disks(scan, config, "ws", "out", Disks{{{"ws", {1, kPlenty}}, {"out", {2, free}}}});
  };
  CHECK(check(points).size() == 1);
  CHECK_THROWS_WITH(check(points - 1), Contains("out: ") && Contains("needs at least "));
}

TEST_CASE(
    "a disk with less than an even scan needs is an error before the run, unless points may be left out") {
  const ScratchFolder folder;
  const FileScan scan({folder.write("scan.ply", ply())}, {});
  io::FilesConfig config = with_limit();
  const std::uint64_t least = run_costs(scan, config, kPoints, kPoints).least_disk;
  const auto check = [&](std::uint64_t free) {
    return check_disks(scan, config, "ws", "out", Disks{{{"ws", {1, free}}, {"out", {2, kPlenty}}}});
  };
  CHECK(check(least).size() == 1);
  CHECK_THROWS_WITH(check(least - 1),
                    Contains("ws: ") && Contains("needs at least ") && Contains("--scratch"));
  config.input.drop_origin = true;
  CHECK(check(least - 1).size() == 1);
}

TEST_CASE("more points than can ever fit in memory are an error before the run") {
  constexpr std::uint64_t kMany = 6'000'000;
  const ScratchFolder folder;
  const std::string header = header_of(kMany), file = folder.write("scan.ply", header);
  std::filesystem::resize_file(file, header.size() + kMany * 12);
  const FileScan scan({file}, {});
  io::FilesConfig config = with_limit();
  config.run.memory_limit = 64 << 20;
  config.neighbourhood.k = 1000;
  const auto not_known = [](const auto&) { return std::nullopt; };
  CHECK_THROWS_WITH(check_disks(scan, config, "ws", "out", not_known),
                    Contains("is too small for 6000000 points"));
}

TEST_CASE("a disk whose space is not known is not checked") {
  const ScratchFolder folder;
  const FileScan scan({folder.write("scan.ply", ply())}, {});
  CHECK(check_disks(scan, with_limit(), "ws", "out", [](const auto&) { return std::nullopt; }).empty());
}

}  // namespace lacuna::test
