// SPDX-License-Identifier: Apache-2.0
// The levels of a scan: which lattices, and which points.
#include "engine/thin/level.hpp"

#include "engine/level_steps.hpp"
#include "engine/scan_steps.hpp"
#include "engine/thin/thin.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

struct AtLevel {
  double edge;
  std::vector<std::uint64_t> ids;  // ascending

  friend bool operator==(const AtLevel&, const AtLevel&) = default;
};

Totals totals_alone(const Level& level, const StepContext& given) {
  return read_totals(evaluate_level(level, {}, given), level.store.tiling(), level.extent);
}

AtLevel seen(const Level& level) {
  AtLevel at{level.edge, {}};
  for (TileIndex t = 0; t < level.store.tiling().tiles.size(); ++t)
    level.store.for_each_point(t, [&](const ScanPoint& p) { at.ids.push_back(value(p.id)); });
  std::sort(at.ids.begin(), at.ids.end());
  return at;
}

// From the first level on.
std::vector<AtLevel> levels_of(const Cloud& cloud, const Config& config) {
  const ScratchFolder folder;
  NoProgress quiet;
  Job job(config, folder.path(), quiet);
  MemoryScan scan(cloud);
  const Parts nothing_kept;
  const StepContext given{scan, nothing_kept, job};
  const Level first = first_level(given);
  std::vector<AtLevel> levels = {seen(first)};
  std::optional<Level> below;
  const auto totals = [&] { return totals_alone(below ? *below : first, given); };
  while (std::optional<Level> level = level_above(below ? *below : first, totals, given)) {
    levels.push_back(seen(*level));
    below.emplace(*std::move(level));
  }
  return levels;
}

bool is_power_of_sqrt2(double edge) {
  return edge == std::ldexp(1.0, std::ilogb(edge)) ||
         edge == std::ldexp(std::numbers::sqrt2, std::ilogb(edge));
}

TEST_CASE(
    "edges are powers of sqrt 2, each level is a part of the one below, and the last has hundreds of "
    "points") {
  const Cloud cloud = plane(100).jittered(0.4, 1).noisy(0.1, 2).scaled(0.37);
  const std::vector<AtLevel> levels = levels_of(cloud, {});
  REQUIRE(levels.size() >= 4);
  CHECK(levels[0].edge == 0);
  CHECK(levels[0].ids.size() == cloud.size());
  for (std::size_t l = 1; l < levels.size(); ++l) {
    INFO("level " << l << ", edge " << levels[l].edge);
    CHECK(is_power_of_sqrt2(levels[l].edge));
    CHECK(levels[l].edge > levels[l - 1].edge);
    CHECK(levels[l].ids.size() <= 0.9 * double(levels[l - 1].ids.size()));
    CHECK(levels[l].ids.size() >= 200);
    CHECK(std::includes(levels[l - 1].ids.begin(), levels[l - 1].ids.end(), levels[l].ids.begin(),
                        levels[l].ids.end()));
  }
  CHECK(levels.back().ids.size() < 800);
}

TEST_CASE("dense places are thinned, sparse ones stay as they are") {
  const Cloud dense = plane(100).jittered(0.3, 1),
              sparse = plane(40).jittered(0.3, 2).scaled(8).translated({0, 0, 50});
  const std::vector<AtLevel> levels = levels_of(dense.joined(sparse), {});
  REQUIRE(levels.size() > 3);
  const auto of_sparse = [&](const AtLevel& level) {
    return std::count_if(level.ids.begin(), level.ids.end(), [&](auto id) { return id >= dense.size(); });
  };
  for (const AtLevel& level : levels)
    if (level.edge > 0 && level.edge < 4) CHECK(of_sparse(level) == 1600);
  CHECK(of_sparse(levels.back()) < 1600);
}

TEST_CASE("few points, no points, and points at one place have no level above") {
  CHECK(levels_of({}, {}).size() == 1);
  CHECK(levels_of(plane(14), {}).size() == 1);  // 196 points
  CHECK(levels_of({std::vector<Eigen::Vector3d>(500, {1, 2, 3}), {}}, {}).size() == 1);
}

TEST_CASE(
    "a smallest hole sets the first level, and a resolution, every point and the paper's method have no "
    "other") {
  Config config;
  CHECK(has_levels(config));
  config.scale.min_hole = 20;
  CHECK(has_levels(config));
  CHECK(levels_of(plane(100), config)[0].edge == 4);
  config = {};
  config.scale.resolution = 3;
  CHECK_FALSE(has_levels(config));
  config = {};
  config.scale.every_point = true;
  CHECK_FALSE(has_levels(config));
  config = {};
  config.loops.method = LoopMethod::kPaper;
  CHECK_FALSE(has_levels(config));
}

}  // namespace
}  // namespace lacuna
