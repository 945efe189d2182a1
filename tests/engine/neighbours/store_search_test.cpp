// SPDX-License-Identifier: Apache-2.0
#include "engine/neighbours/store_search.hpp"

#include "engine/model/neighbourhoods.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/point_tree.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

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

}  // namespace
}  // namespace lacuna
