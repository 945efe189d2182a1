// SPDX-License-Identifier: Apache-2.0
// The exchange between tiles: wedges are those of a single tile, and close to curves.
#include "engine/boundary/tangential/exchange.hpp"

#include "engine/boundary/tangential/tangential_boundary.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna::tangential {
namespace {

// A wedge with the ids of its points, its ends in either order.
struct NamedWedge {
  PointId point, low, high;
  Scale scale;
  double length, sampling_radius, distance;
  float clearness, surface;

  auto operator<=>(const NamedWedge&) const = default;
};

struct Found {
  std::vector<NamedWedge> wedges;  // sorted
  std::size_t tiles = 0;
  bool across_tiles = false;  // some were left to the exchange
};

Found wedges_of(const Cloud& cloud, std::int64_t tile_points, std::int64_t threads = 2) {
  TiledScan scan(cloud, tiled({}, tile_points, threads));
  const Tiling& tiling = scan.store.tiling();
  std::map<Row, PointId> ids;
  for (const auto& [id, row] : scan.rows()) ids.emplace(row, id);
  constexpr RecordStream<Wedge> kCertain{"certain wedges"};
  constexpr RecordStream<CurvePoint> kCertainPoints{"their points"};
  const TileOutputs outputs = scan.evaluate({[&](const EvaluatedTile& tile, TileOutput& output) {
    TileBoundary boundary(tile, scan.config.tangential);
    boundary.emit(output);
    std::vector<CurvePoint> points;
    for (const Wedge& wedge : boundary.wedges()) points.push_back(boundary.curve_point(wedge));
    output.add(kCertain, boundary.wedges());
    output.add(kCertainPoints, std::move(points));
  }});
  BorderExchange exchange(outputs, tiling, scan.config.tangential, scan.job.spill, scan.job.workers);
  exchange.find_active_points();

  Found found{.tiles = tiling.tiles.size()};
  const auto add = [&](std::span<const Wedge> wedges, std::span<const CurvePoint> points) {
    for (std::size_t i = 0; i < wedges.size(); ++i) {
      const auto [low, high] = std::minmax(ids.at(wedges[i].from), ids.at(wedges[i].to));
      const auto& [length, sampling_radius, distance, clearness, surface] = points[i].evidence;
      found.wedges.push_back(
          {points[i].id, low, high, wedges[i].scale, length, sampling_radius, distance, clearness, surface});
    }
  };
  for (TileIndex tile = 0; tile < tiling.tiles.size(); ++tile) {
    const OpenWedges open = exchange.wedges(tile);
    CHECK(open.wedges.size() <= exchange.most_wedges(tile));
    found.across_tiles |= !open.wedges.empty();
    add(open.wedges, open.points);
    add(outputs.read(kCertain, tile), outputs.read(kCertainPoints, tile));
  }
  std::sort(found.wedges.begin(), found.wedges.end());
  return found;
}

// Edges of the curves that wedges form: each is an edge of the wedges at both of its ends.
bool are_closed(const std::vector<NamedWedge>& wedges) {
  // As many from the lower id as from the higher one.
  std::map<std::tuple<Scale, PointId, PointId>, int> edges;
  for (const NamedWedge& wedge : wedges) {
    for (const PointId other : {wedge.low, wedge.high}) {
      if (wedge.point < other) ++edges[{wedge.scale, wedge.point, other}];
      if (other < wedge.point) --edges[{wedge.scale, other, wedge.point}];
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
}

void check_tilings(const Cloud& cloud) {
  const Found whole = wedges_of(cloud, 1'000'000);
  CHECK(whole.tiles <= 2);  // points far from all others are set aside
  CHECK(are_closed(whole.wedges));
  for (const std::int64_t tile_points : {1, 30, 250}) {
    INFO(tile_points << " points a tile");
    const bool same = wedges_of(cloud, tile_points).wedges == whole.wedges;
    CHECK(same);
  }
}

TEST_CASE("wedges around holes that lie across tiles are those of a single tile") {
  const Cloud cloud = plane(40).punched({13, 14}, 4).punched({27, 25}, 6).jittered(0.25, 3);
  const Found parts = wedges_of(cloud, 60);
  CHECK(parts.tiles > 20);
  CHECK(parts.across_tiles);
  CHECK(parts.wedges.size() > 100);
  check_tilings(cloud);
}

void check_drawn(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    INFO("seed " << seed);
    check_tilings(random_cloud(20'000 + seed));
  }
}

TEST_CASE("wedges of drawn clouds are those of a single tile, and close to curves") {
  check_drawn(1, draws(12));
}

TEST_CASE("wedges of many more drawn clouds are those of a single tile, and close to curves", "[.slow]") {
  check_drawn(13, 12 + draws(100));
}

}  // namespace
}  // namespace lacuna::tangential
