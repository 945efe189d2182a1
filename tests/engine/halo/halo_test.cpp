// SPDX-License-Identifier: Apache-2.0
#include "engine/halo/halo.hpp"

#include "tests/support/point_tree.hpp"
#include "tests/support/tile.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

// One link, and whose inbox it is in: tile, owned point, foreign row and id, incoming.
using Letter = std::tuple<TileIndex, LocalIndex, Row, PointId, std::uint32_t>;

// Every edge from a point of `from` to one of its k nearest in another tile, sent to both.
std::vector<Letter> letters_plainly(const TiledScan& scan, const Cloud& cloud,
                                    const std::set<PointId>& from) {
  const std::map<PointId, Row> rows = scan.rows();
  const std::vector<PointId> ids = distinct_ids(cloud);
  std::vector<Eigen::Vector3d> positions;
  for (const PointId id : ids) positions.push_back(cloud.positions[value(id)]);
  std::vector<Letter> outbox;
  for (const PointId p : from) {
    const Row p_row = rows.at(p);
    const auto at = static_cast<LocalIndex>(std::ranges::lower_bound(ids, p) - ids.begin());
    for (const Neighbour& near :
         nearest_plainly(positions, ids, at, std::size_t(scan.config.neighbourhood.k))) {
      const PointId q = near.id;
      const Row q_row = rows.at(q);
      if (scan.tile_of(p_row) == scan.tile_of(q_row)) continue;
      outbox.emplace_back(scan.tile_of(p_row), scan.local(p_row), q_row, q, 0);
      outbox.emplace_back(scan.tile_of(q_row), scan.local(q_row), p_row, p, 1);
    }
  }
  std::sort(outbox.begin(), outbox.end());
  return outbox;
}

// What has arrived of the edges from points of `from`.
std::vector<Letter> letters_sent(TiledScan& scan, const Cloud& cloud, const std::set<PointId>& from) {
  const AppendLists<HaloEdge> inboxes = exchange_halo(scan.store, scan.all_tiles(), scan.job);
  std::vector<Letter> outbox;
  std::size_t moved = 0;
  for (TileIndex t = 0; t < inboxes.lists(); ++t) {
    const std::vector<ScanPoint> owned = scan.store.points(t);
    for (const HaloEdge& link : inboxes.read(t)) {
      moved += link.foreign.position() != cloud.positions[value(link.foreign.id)];
      if (from.contains(link.incoming ? link.foreign.id : owned.at(link.owned).id))
        outbox.emplace_back(t, link.owned, link.row, link.foreign.id, link.incoming);
    }
  }
  CHECK(moved == 0);
  std::sort(outbox.begin(), outbox.end());
  return outbox;
}

void check_links(const Cloud& cloud, const Config& config, const std::set<PointId>& from) {
  TiledScan scan(cloud, config);
  const std::vector<Letter> expected = letters_plainly(scan, cloud, from);
  const bool same = letters_sent(scan, cloud, from) == expected;  // without printing them
  CHECK(same);
  CHECK(expected.empty() == (scan.store.tiling().tiles.size() < 2));
}

void check_links(const Cloud& cloud, const Config& config) {
  const std::vector<PointId> ids = distinct_ids(cloud);
  check_links(cloud, config, {ids.begin(), ids.end()});
}

TEST_CASE("every edge to a nearest neighbour in another tile is sent to both tiles, once") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Cloud cloud = random_cloud(9000 + seed);
    for (const std::int64_t tile_points : {1, 20, 300}) {
      INFO("seed " << seed << ", " << cloud.size() << " points, " << tile_points << " a tile");
      Config config = tiled({}, tile_points, seed % 2 == 0 ? 8 : 1);
      config.neighbourhood.k = std::int64_t(1 + 5 * seed);
      check_links(cloud, config);
    }
  }
}

TEST_CASE("ties, steps of density and lone outliers are sent to both tiles, once") {
  for (const std::int64_t tile_points : {1, 100, 1500}) check_links(hard_cloud(4), tiled({}, tile_points));
}

// From so far above, all of the plane is within the bound of the outlier's cell. Its neighbours are searched
// one cell after the other. Those next to the centre come four at a distance.
TEST_CASE("an outlier that has tens of thousands of points within its reach finds its nearest ones") {
  Cloud cloud = plane(200);
  std::set<PointId> from;
  for (std::uint64_t id = 0; id < cloud.size(); id += 199) from.insert(PointId{id});
  for (const double height : {1e4, 2e4, -1e5}) {
    from.insert(PointId{cloud.size()});
    cloud.positions.push_back({99.5, 99.5, height});
  }
  check_links(cloud, tiled({}, 3000), from);
}

// Two of the four points at the distance of the 27th neighbour are wanted: those with the lower ids. They are
// at the near corners of cells that are no nearer than the other two points.
TEST_CASE("an outlier's farthest neighbours tie with points in cells that it has not looked into") {
  Cloud cloud = plane(200);
  std::reverse(cloud.positions.begin(), cloud.positions.end());
  const PointId outlier{cloud.size()};
  cloud.positions.push_back({101, 101, -1e5});
  Config config = tiled({}, 3000);
  config.neighbourhood.k = 27;
  check_links(cloud, config, {outlier});
}

// This is the case near a scanner: the bound covers no more than a few times what is in the cell itself. One
// point after the other, as for outliers, would take thousands of times as long.
TEST_CASE("tens of thousands of points in one cell find their neighbours in it and in other tiles") {
  Cloud cloud = plane(200);
  std::set<PointId> from;
  for (std::uint64_t id = 0; id < cloud.size(); id += 331) from.insert(PointId{id});
  Random random(1);
  for (int i = 0; i < 40'000; ++i) {
    if (i % 997 == 0) from.insert(PointId{cloud.size()});
    cloud.positions.push_back({99.5 + random.uniform(-0.2, 0.2), 99.5 + random.uniform(-0.2, 0.2), 0.1});
  }
  for (const std::int64_t tile_points : {3000, 20'000}) check_links(cloud, tiled({}, tile_points), from);
}

TEST_CASE("one tile, or none, has no links") {
  for (const int n : {0, 1, 300}) check_links(scattered(n, 1), tiled({}, 1'000'000));
}

}  // namespace
}  // namespace lacuna
