// SPDX-License-Identifier: Apache-2.0
// Neighbours in a tile, in the store, and those that are sent between tiles, against looking at every point.
#include "engine/halo/halo.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/neighbours/block_search.hpp"
#include "engine/neighbours/store_search.hpp"
#include "tests/support/point_tree.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

// ---- In blocks, in any order of the points

struct Points {
  std::vector<Eigen::Vector3d> positions;
  std::vector<PointId> ids;
};

// Distinct finite points in the order of the cloud, or sorted by x first; ids shuffled.
Points points_of(const Cloud& cloud, bool sorted) {
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
  };
  std::map<Eigen::Vector3d, bool, decltype(before)> seen(before);
  Points points;
  for (const Eigen::Vector3d& p : cloud.positions) {
    if (p.allFinite() && seen.emplace(p.array() + 0.0, true).second)
      points.positions.push_back(p.array() + 0.0);
  }
  if (sorted) std::sort(points.positions.begin(), points.positions.end(), before);
  for (std::size_t i = 0; i < points.positions.size(); ++i)
    points.ids.push_back(PointId{(i * 7919 + 13) % 1'000'003});
  return points;
}

bool same(std::span<const LocalIndex> found, const std::vector<Neighbour>& expected) {
  return std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                    [](LocalIndex a, const Neighbour& b) { return a == b.index; });
}

void check_all(const Points& points, std::size_t k, LocalIndex first = 0) {
  BlockSearch search(points.positions, points.ids);
  std::size_t wrong = 0;
  const auto last = static_cast<LocalIndex>(points.positions.size());
  LocalIndex expected_query = first;
  search.nearest(first, last, k, [&](LocalIndex query, std::span<const LocalIndex> found) {
    CHECK(query == expected_query++);
    wrong += !same(found, nearest_plainly(points.positions, points.ids, query, k));
  });
  CHECK(expected_query == last);
  CHECK(wrong == 0);
}

void check_balls(BlockSearch& search, const PointTree& tree, LocalIndex first, LocalIndex last,
                 double radius) {
  std::vector<Neighbour> expected;
  std::size_t wrong = 0;
  search.within(first, last, radius, [&](LocalIndex query, std::span<const LocalIndex> found) {
    tree.within(query, radius * radius, expected);
    wrong += !same(found, expected);
  });
  CHECK(wrong == 0);
}

TEST_CASE("exact ties on a lattice are decided by id, in blocks too") {
  for (const std::size_t k : {1, 6, 7, 15, 26}) check_all(points_of(lattice(7), true), k);
}

// The first query looks no farther than its last neighbour, and as many points are as far in true distances
// or rounded ones.
TEST_CASE("neighbours that end where the search does") {
  const Points points = points_of(plane(24).scaled(0.1).rotated({1, 2, 3}, 40), true);
  std::size_t wrong = 0;
  for (LocalIndex first = 0; first < points.positions.size(); first += 32) {
    for (std::size_t k = 1; k <= 24; ++k) {
      BlockSearch search(points.positions, points.ids);
      const LocalIndex last =
          std::min<LocalIndex>(first + 32, static_cast<LocalIndex>(points.positions.size()));
      search.nearest(first, last, k, [&](LocalIndex query, std::span<const LocalIndex> found) {
        if (query == first) wrong += !same(found, nearest_plainly(points.positions, points.ids, query, k));
      });
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("balls that end at a point hold it") {
  const Points points = points_of(plane(24).scaled(0.1).rotated({1, 2, 3}, 40), true);
  const auto last = static_cast<LocalIndex>(points.positions.size());
  const PointTree tree(points.positions, points.ids);
  BlockSearch search(points.positions, points.ids);
  for (const LocalIndex end : {1, 2, 30, 55, 77, 200}) {
    const double radius = std::sqrt(squared_distance(points.positions[0], points.positions[end]));
    check_balls(search, tree, 0, last, radius);
  }
}

TEST_CASE("queries may start anywhere, and fewer points than k are all neighbours") {
  check_all(points_of(plane(20).jittered(0.2, 1), true), 15, 133);
  for (const int n : {1, 2, 15, 16, 17, 33}) check_all(points_of(scattered(n, 4), false), 16);
}

TEST_CASE("the search in blocks agrees with a kd-tree on many points, within a radius too") {
  Random random(5);
  Cloud cloud;
  for (int i = 0; i < 60'000; ++i) {  // a density step, noise, and a few points far away
    const double spread = i % 100 == 0 ? 50 : 1;
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    cloud.positions.push_back({spread * (x < 0 ? 4 * x : x), spread * y, random.uniform(-0.002, 0.002)});
  }
  const Points points = points_of(cloud, true);
  const auto last = static_cast<LocalIndex>(points.positions.size());
  const PointTree tree(points.positions, points.ids);
  BlockSearch search(points.positions, points.ids);
  std::vector<Neighbour> expected;
  std::size_t wrong = 0;
  const auto check_nearest = [&](LocalIndex query, std::span<const LocalIndex> found) {
    tree.nearest(query, 15, expected);
    wrong += !same(found, expected);
  };
  search.nearest(0, last, 15, check_nearest);
  for (const double radius : {0.004, 0.03, 0.2}) check_balls(search, tree, 1000, 3000, radius);
  search.nearest(5, 9, 15, check_nearest);  // once more, after balls
  CHECK(wrong == 0);
}

// ---- In the store

TEST_CASE("the neighbours of single stored points are those of a plain search") {
  for (const auto& [cloud, k] : {std::pair{hard_cloud(1), 15},
                                 {scattered(3000, 2), 48},
                                 {lattice(12), 20},
                                 {scattered(5, 3), 15},
                                 {scattered(1, 3), 15}}) {
    TiledScan scan(cloud, tiled({}, 300));
    std::vector<ScanPoint> points;
    std::vector<Eigen::Vector3d> positions;
    std::vector<PointId> ids;
    for (TileIndex t = 0; t < scan.store.tiling().tiles.size(); ++t)
      for (const ScanPoint& p : scan.store.points(t))
        points.push_back(p), positions.push_back(p.position()), ids.push_back(p.id);
    const std::map<PointId, Row> row_of = scan.rows();
    StoreSearch search(scan.store);
    for (LocalIndex i = 0; i < points.size(); i += 1 + points.size() / 60) {
      const std::vector<Neighbour> plain = nearest_plainly(positions, ids, i, std::size_t(k));
      std::vector<StoreNeighbour> found = search.nearest(points[i], row_of.at(points[i].id), k);
      std::sort(found.begin(), found.end());
      CHECK(std::equal(plain.begin(), plain.end(), found.begin(), found.end(),
                       [&](const Neighbour& a, const StoreNeighbour& b) {
                         return a.id == b.id && row_of.at(a.id) == b.row &&
                                a.squared_distance == b.squared_distance;
                       }));
    }
  }
}

// ---- Sent between tiles

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

}  // namespace
}  // namespace lacuna
