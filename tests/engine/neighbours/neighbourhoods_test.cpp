// SPDX-License-Identifier: Apache-2.0
#include "engine/neighbours/neighbourhoods.hpp"

#include "tests/support/reference.hpp"
#include "tests/support/tile.hpp"

namespace lacuna {
namespace {

std::vector<std::vector<PointId>> ids_of(const Neighbourhoods& rows, const TilePoints& points) {
  std::vector<std::vector<PointId>> ids(rows.size());
  for (std::size_t p = 0; p < rows.size(); ++p)
    for (const LocalIndex q : rows[p]) ids[p].push_back(points.ids[q]);
  return ids;
}

// Returns the neighbourhoods of the tile's owned points; nothing after section 1 is computed beyond what it
// must.
std::vector<std::vector<PointId>> plain(const Cloud& cloud, const TilePoints& points, std::size_t k,
                                        double eps) {
  Config config;
  config.neighbourhood = {.k = static_cast<std::int64_t>(k), .eps = eps};
  config.loops.method = LoopMethod::kPaper;
  config.spanning.max_prob_weight = 1e-9;
  const reference::Detection result = reference::detect(cloud.positions, {}, config);
  std::vector<std::vector<PointId>> ids;
  for (LocalIndex p = 0; p < points.owned; ++p) ids.push_back(result.points[value(points.ids[p])].neighbours);
  return ids;
}

TEST_CASE("neighbourhoods are those of the plain method, in order, with and without an eps ball") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Cloud cloud = random_cloud(1000 + seed);
    Random random(seed);
    const auto k = static_cast<std::size_t>(random.whole(1, 30));
    const double spacing = typical_spacing(cloud);
    const TilePoints points = whole_tile(cloud);
    for (const double eps : {0.0, spacing * random.uniform(0.5, 3)}) {
      INFO("seed " << seed << ", k " << k << ", eps " << eps);
      CHECK(ids_of(find_neighbourhoods(points, k, eps), points) == plain(cloud, points, k, eps));
    }
  }
}

TEST_CASE("a tile that owns a part of the points gives them the neighbourhoods of the whole") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Cloud cloud = scattered(400, seed).joined(scattered(400, seed + 50).scaled(0.1)).rounded(0.01);
    Random random(seed);
    std::vector<bool> owns;
    for (const Eigen::Vector3d& p : cloud.positions) owns.push_back(p.x() < 0.08);
    const TilePoints points = part_tile(cloud, owns, 12);
    REQUIRE(points.owned > 50);
    REQUIRE(points.owned < points.size());
    for (const double eps : {0.0, 0.05})
      CHECK(ids_of(find_neighbourhoods(points, 12, eps), points) == plain(cloud, points, 12, eps));
  }
}

}  // namespace
}  // namespace lacuna
