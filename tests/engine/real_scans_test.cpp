// SPDX-License-Identifier: Apache-2.0
// Tiling never shows, on real scans: every byte of the result for every tile size, thread count and memory
// limit. Slow: minutes.
#include "io/read/scan/scan_pass.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/test.hpp"

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

std::string bytes_of(const fs::path& file, const Setting& setting, bool orient) {
  Config config;
  config.normals.orient = orient;
  config.run = {
      .threads = setting.threads, .memory_limit = setting.memory_limit, .tile_points = setting.tile_points};
  const ScanFiles scan({file}, {});
  ScanPass pass(scan);
  return run_engine(pass, config).bytes();
}

const std::vector<Setting> kAll = {
    {500, 1, 0},    {500, 8, kLeast}, {5'000, 2, 0},         {5'000, 8, kLeast}, {50'000, 1, kLeast},
    {50'000, 8, 0}, {kOneTile, 8, 0}, {kOneTile, 2, kLeast}, {0, 0, 0},          {0, 8, kLeast}};
const std::vector<Setting> kSome = {{500, 8, 0}, {5'000, 2, kLeast}, {50'000, 8, kLeast}};

TEST_CASE("tiling never shows on real scans", "[.slow]") {
  const auto shared = test::shared_folder();
  if (!shared) return;
  const auto [name, settings, orient] = GENERATE(table<const char*, const std::vector<Setting>*, bool>(
      {{"bun_zipper.ply", &kAll, true},
       {"bun000.ply", &kAll, true},
       {"lato000.ply", &kAll, true},                 // a raw range map with stray vertices
       {"dragon_30scans_793k.ply", &kSome, true},    // registered
       {"vol_total.ply", &kSome, true},              // an aerial survey
       {"balm_23scans_1.7M.ply", &kSome, false}}));  // lidar, of strongly varying density
  const fs::path file = *shared / "data" / name;
  if (!fs::exists(file)) return test::skip("no " + file.string());
  const std::string expected = bytes_of(file, {kOneTile, 1, 0}, orient);
  CHECK(!expected.empty());
  for (const Setting& s : *settings) {
    INFO(name << ": " << s.tile_points << " points a tile, " << s.threads << " threads, limit "
              << s.memory_limit);
    const bool same = bytes_of(file, s, orient) == expected;
    CHECK(same);
  }
}

}  // namespace
}  // namespace lacuna
