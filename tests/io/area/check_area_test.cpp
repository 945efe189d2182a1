// SPDX-License-Identifier: Apache-2.0
#include "io/area/check_area.hpp"

#include "engine/run/error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::io {
namespace {

struct PhaseNames final : Progress {
  void begin(std::string_view phase, std::uint64_t) override { names.emplace_back(phase); }
  void advance(std::uint64_t) override {}
  void end() noexcept override {}
  std::vector<std::string> names;
};

TEST_CASE("outlines that are far too long are refused after the first pass", "[io][area]") {
  constexpr double kEdge = 100, kVoid = 1.5;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, kEdge);
  std::string text;
  for (int i = 0; i < 10'000; ++i)
    text += std::to_string(place(random)) + " " + std::to_string(place(random)) + " 0\n";
  const test::ScratchFolder folder;
  FileScan scan({folder.write("a.xyz", text)}, {.columns = "x y z"});
  constexpr auto kCells = static_cast<std::size_t>(kEdge / kVoid * PlanGrid::kCells);
  const Area area{.polygons = {{{{0, 0}, {kEdge, 0}, {kEdge, kEdge}, {0, kEdge}}}},
                  .grid = {.size = kVoid, .columns = kCells, .rows = kCells}};
  FilesConfig config;
  config.area.void_rule = "1.5";
  const auto phases = [&](std::uint64_t memory) {
    PhaseNames progress;
    config.run.memory_limit = memory;
    CHECK_THROWS_WITH(check_area(area, scan, config, progress),
                      Catch::Matchers::Contains("outlines of voids have at least"));
    return progress.names;
  };
  CHECK(phases(2 << 20) == std::vector<std::string>{"area"});
}

}  // namespace
}  // namespace lacuna::io
