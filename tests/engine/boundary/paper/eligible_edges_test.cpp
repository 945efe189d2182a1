// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/eligible_edges.hpp"

#include "engine/evaluate/evaluate.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/tile.hpp"

#include <algorithm>
#include <map>

#include <catch2/catch.hpp>

namespace lacuna::paper {
namespace {

using Edges = std::map<std::pair<PointId, PointId>, double>;

std::pair<PointId, PointId> ends(PointId a, PointId b) {
  return std::minmax(a, b);
}

Edges plain_edges(const reference::Detection& plain) {
  Edges edges;
  for (const reference::Edge& e : plain.eligible) edges[{e.low, e.high}] = e.weight;
  return edges;
}

TEST_CASE("an edge is eligible only strictly below both thresholds") {
  const SpanningConfig config{.max_prob_weight = 1.0, .max_total_weight = 3.0};
  const float step = 0x1p-24f;
  CHECK(eligible_weight({1.0, 0.5f}, {1.0, 0.5f}, 1.0, config) < 0);
  CHECK(eligible_weight({1.0, 0.5f + step}, {1.0, 0.5f}, 1.0, config) == 2.0 - 0x1p-24);
  CHECK(eligible_weight({1.0, 1.0f}, {1.0, 1.0f}, 3.0, config) < 0);
  CHECK(eligible_weight({1.0, 1.0f}, {1.0, 1.0f}, 2.9375, config) == 2.9375);
  CHECK(eligible_weight({2.0, 1.0f}, {4.0, 1.0f}, 3.0, config) == 1.0);
}

TEST_CASE("eligible edges are those of the plain method, each once, with their weights") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Cloud cloud = random_cloud(3000 + seed);
    Config config = with_paper_loops(random_config(3000 + seed, typical_spacing(cloud)));
    config.normals.orient = false;
    config.neighbourhood.k = std::min<std::int64_t>(config.neighbourhood.k, 15);
    const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
    const TilePoints points = whole_tile(cloud);
    const Neighbourhoods rows =
        find_neighbourhoods(points, static_cast<std::size_t>(config.neighbourhood.k), plain.eps);
    const TileEdges found = eligible_edges(
        points, rows, evaluate(points, rows, owned_normals(cloud, points), config.normals, config.criteria),
        config.spanning);
    Edges edges;
    for (const TileEdge& e : found.inside) edges[ends(points.ids[e.a], points.ids[e.b])] = e.weight;
    INFO("seed " << seed);
    CHECK(edges.size() == found.inside.size());
    CHECK(found.crossings.empty());
    CHECK(edges == plain_edges(plain));
  }
}

TEST_CASE("the tile of a strong end reports an eligible edge between tiles") {
  const Cloud cloud = plane(14).punched({7, 7}, 3).jittered(0.2, 5);
  Config config = with_paper_loops({});
  const reference::Detection plain = reference::detect(cloud.positions, {}, config);
  const auto strength = [&](PointId id) {
    const reference::Point& p = plain.points[value(id)];
    return Strength{p.mean_distance, static_cast<float>(p.probability)};
  };
  std::vector<bool> left, right;
  for (const Eigen::Vector3d& p : cloud.positions) left.push_back(p.x() < 7), right.push_back(p.x() >= 7);
  Edges edges;
  for (const std::vector<bool>& owns : {left, right}) {
    const TilePoints points = part_tile(cloud, owns, 15);
    const Neighbourhoods rows = find_neighbourhoods(points, 15, 0);
    const TileEdges found = eligible_edges(
        points, rows, evaluate(points, rows, {}, config.normals, config.criteria), config.spanning);
    REQUIRE_FALSE(found.crossings.empty());
    for (const TileEdge& e : found.inside) edges[ends(points.ids[e.a], points.ids[e.b])] = e.weight;
    for (const Crossing& c : found.crossings) {
      const PointId a = points.ids[c.owned], b = points.ids[c.foreign];
      CHECK(is_strong(strength(a).probability, config.spanning));
      const double weight = eligible_weight(strength(a), strength(b), c.distance, config.spanning);
      if (weight >= 0) edges[ends(a, b)] = weight;
    }
  }
  CHECK(edges == plain_edges(plain));
}

}  // namespace
}  // namespace lacuna::paper
