// SPDX-License-Identifier: Apache-2.0
// Tiling never shows, on real scans: every byte of the result for every tile size, thread count and memory
// limit. Slow: minutes.
#include "io/scan/file_scan.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/skip.hpp"

#include <filesystem>

#include <catch2/catch.hpp>

namespace lacuna {
using namespace io;

namespace {

struct Setting {
  std::int64_t tile_points;
  std::int64_t threads;
  std::uint64_t memory_limit;
};

constexpr std::int64_t kOneTile = 1'000'000'000;
constexpr std::uint64_t kLeast = 64 << 20;

std::string bytes_of(const std::filesystem::path& file, const Setting& setting, bool orient) {
  Config config;
  config.normals.orient = orient;
  config.run = {
      .threads = setting.threads, .memory_limit = setting.memory_limit, .tile_points = setting.tile_points};
  FileScan scan({file}, {});
  return run_engine(scan, config).bytes();
}

void check_tiling(const std::string& name, const std::vector<Setting>& settings, bool orient = true) {
  const auto shared = shared_folder();
  if (!shared) return;
  if (!std::filesystem::exists(*shared / "data" / name)) {
    test::skip("no " + name);
    return;
  }
  const std::filesystem::path file = *shared / "data" / name;
  const std::string expected = bytes_of(file, {kOneTile, 1, 0}, orient);
  CHECK(!expected.empty());
  for (const Setting& s : settings) {
    INFO(name << ": " << s.tile_points << " points a tile, " << s.threads << " threads, limit "
              << s.memory_limit);
    const bool same = bytes_of(file, s, orient) == expected;
    CHECK(same);
  }
}

const std::vector<Setting> kAll = {
    {500, 1, 0},    {500, 8, kLeast}, {5'000, 2, 0},         {5'000, 8, kLeast}, {50'000, 1, kLeast},
    {50'000, 8, 0}, {kOneTile, 8, 0}, {kOneTile, 2, kLeast}, {0, 0, 0},          {0, 8, kLeast}};

TEST_CASE("tiling never shows on the bunny, whole and as a single range map", "[.slow]") {
  check_tiling("bun_zipper.ply", kAll);
  check_tiling("bun000.ply", kAll);
}

TEST_CASE("tiling never shows on a raw range map with stray vertices", "[.slow]") {
  check_tiling("lato000.ply", kAll);
}

TEST_CASE("tiling never shows on thirty registered scans", "[.slow]") {
  check_tiling("dragon_30scans_793k.ply", {{500, 8, 0}, {5'000, 2, kLeast}, {50'000, 8, kLeast}});
}

TEST_CASE("tiling never shows on an aerial survey", "[.slow]") {
  check_tiling("vol_total.ply", {{500, 8, 0}, {5'000, 2, kLeast}, {50'000, 8, kLeast}});
}

TEST_CASE("tiling never shows on lidar scans of strongly varying density", "[.slow]") {
  check_tiling("balm_23scans_1.7M.ply", {{500, 8, 0}, {5'000, 2, kLeast}}, false);
}

}  // namespace
}  // namespace lacuna
