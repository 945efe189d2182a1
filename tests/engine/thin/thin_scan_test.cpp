#include "engine/thin/thin_scan.hpp"

#include "engine/run/error.hpp"
#include "engine/thin/lattice.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/tiled_scan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using CellKey = std::array<double, 3>;

CellKey key(const Eigen::Vector3d& position, double resolution) {
  const Eigen::Vector3d cell = Lattice(resolution).place_of(position).cell;
  return {cell.x(), cell.y(), cell.z()};
}

struct Thinned {
  Thinned(const Cloud& cloud, double resolution, Config given = {})
      : config(given), job(config, folder.path(), quiet), scan(cloud) {
    thinned.emplace(thin_scan(scan, resolution, job));
  }

  std::vector<Representative> representatives() const {
    return thinned->representatives->read(0, thinned->representatives->size());
  }

  test::ScratchFolder folder;
  Config config;
  NoProgress quiet;
  Job job;
  MemoryScan scan;
  std::optional<ThinnedScan> thinned;
};

bool same(const Representative& a, const Representative& b) {
  return a.point.id == b.point.id && a.point.position() == b.point.position() && a.normal.x == b.normal.x &&
         a.normal.y == b.normal.y && a.normal.z == b.normal.z;
}

TEST_CASE("each occupied cell has one representative, with its position and normal") {
  Cloud cloud = scattered(20'000, 1).noisy(0.2, 1).with_unusable(100, 2);
  for (const Eigen::Vector3d& p : cloud.positions) cloud.normals.push_back(2 * p);
  const Thinned thin(cloud, 0.05);
  const std::vector<Representative> representatives = thin.representatives();
  std::set<CellKey> occupied, represented;
  std::size_t finite = 0;
  for (const Eigen::Vector3d& p : cloud.positions) {
    if (!p.allFinite()) continue;
    ++finite;
    occupied.insert(key(p, 0.05));
  }
  for (const Representative& r : representatives) {
    represented.insert(key(r.point.position(), 0.05));
    CHECK(r.point.position() == cloud.positions[value(r.point.id)]);
    CHECK(Eigen::Vector3d(r.normal.x, r.normal.y, r.normal.z) == cloud.normals[value(r.point.id)]);
  }
  CHECK(represented == occupied);
  CHECK(representatives.size() == occupied.size());
  CHECK(thin.thinned->points == cloud.size());
  CHECK(thin.thinned->dropped == cloud.size() - finite);
  CHECK_FALSE(thin.thinned->represented);
}

TEST_CASE("within little memory the representatives are the same, and each point has its own") {
  const Cloud cloud = scattered(400'000, 3).scaled(1000);
  Config small;
  small.run.memory_limit = std::uint64_t{64} << 20;
  small.output.points = true;
  const Thinned all(cloud, 1), shared(cloud, 1, small);
  const std::vector<Representative> a = all.representatives(), b = shared.representatives();
  REQUIRE(a.size() > 300'000);
  REQUIRE(a.size() == b.size());
  CHECK(std::equal(a.begin(), a.end(), b.begin(), same));

  // Each point has the representative of its cell.
  std::map<CellKey, PointId> of_cell;
  for (const Representative& r : a) of_cell[key(r.point.position(), 1)] = r.point.id;
  std::vector<int> times(cloud.size());
  std::size_t wrong = 0;
  for (std::size_t block = 0; block < shared.thinned->represented->lists(); ++block) {
    shared.thinned->represented->for_each(block, [&](const Represented& r) {
      ++times[value(r.id)];
      wrong += value(r.representative) / kRepresentedBlock != block;
      wrong += r.representative != of_cell[key(cloud.positions[value(r.id)], 1)];
    });
  }
  CHECK(wrong == 0);
  CHECK(std::all_of(times.begin(), times.end(), [](int t) { return t == 1; }));
}

TEST_CASE("representatives are read in batches with the ids of the input") {
  const Cloud cloud = scattered(200'000, 4).scaled(1000);
  const Thinned thin(cloud, 2);
  const std::unique_ptr<PointSource> source = read_representatives(*thin.thinned);
  const std::vector<Representative> representatives = thin.representatives();
  CHECK(source->expected_points() == representatives.size());
  CHECK_FALSE(source->has_normals());
  for (int time = 0; time < 2; ++time) {
    source->rewind();
    std::size_t read = 0, wrong = 0, batches = 0;
    for (PointBatch batch; source->next(batch); ++batches) {
      for (std::size_t i = 0; i < batch.size(); ++i, ++read) {
        wrong += batch.id(i) != representatives[read].point.id;
        wrong += batch.positions[i] != representatives[read].point.position();
      }
    }
    CHECK(read == representatives.size());
    CHECK(wrong == 0);
    CHECK(batches > 1);
  }
}

TEST_CASE("the points of a store have the same representatives as the scan, under any tiling") {
  Cloud cloud = scattered(30'000, 5).noisy(0.1, 5);
  for (const Eigen::Vector3d& p : cloud.positions) cloud.normals.push_back(2 * p);
  const Thinned thin(cloud, 0.05);
  for (const std::int64_t tile_points : {200, 5'000, 1'000'000}) {
    TiledScan tiled_scan(cloud, tiled({}, tile_points));
    const ThinnedScan of_store = thin_store(tiled_scan.store, 0.05, tiled_scan.job);
    const std::vector<Representative> expected = thin.representatives(),
                                      found =
                                          of_store.representatives->read(0, of_store.representatives->size());
    REQUIRE(found.size() == expected.size());
    CHECK(std::equal(found.begin(), found.end(), expected.begin(), same));
    CHECK(of_store.points == cloud.size());
  }
}

TEST_CASE("a point that is too far away for the resolution is an error that names it") {
  Cloud cloud = plane(3);
  cloud.positions[4] = {1e300, 0, 0};
  CHECK_THROWS_WITH(Thinned(cloud, 1e-9), Catch::Matchers::Contains("point 4") &&
                                              Catch::Matchers::Contains("a larger one is needed"));
}

TEST_CASE("no points, or none that are finite, have no representatives") {
  CHECK(Thinned({}, 1).representatives().empty());
  const Thinned thin({std::vector(5, Eigen::Vector3d::Constant(std::nan("")).eval()), {}}, 1);
  CHECK(thin.representatives().empty());
  CHECK(thin.thinned->dropped == 5);
}

}  // namespace
}  // namespace lacuna
