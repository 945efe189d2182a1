// SPDX-License-Identifier: Apache-2.0
#include "engine/results/probability_voxels.hpp"

#include "engine/pipeline.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

struct Voxels {
  ProbabilityLattice lattice;
  std::map<CellCoord, float> values;
  std::vector<float> points;  // probabilities of the input's points
  double mean_edge_length = 0;
  std::size_t repeated = 0;
};

Voxels voxels_of(const Cloud& cloud, Config config = {}) {
  const test::ScratchFolder folder;
  config.results.voxels = true;
  config.results.points = true;
  MemoryScan scan(cloud);
  NoProgress quiet;
  const auto detection = detect(scan, config, folder.path(), quiet);
  Voxels voxels{.lattice = detection->probability_lattice,
                .mean_edge_length = detection->summary.mean_edge_length};
  detection->for_each_probability_voxel([&](const ProbabilityVoxel& voxel) {
    voxels.repeated += !voxels.values.emplace(voxel.coord, voxel.probability).second;
  });
  detection->for_each_result_block([&](PointId, std::span<const PointResult> results) {
    for (const PointResult& result : results) voxels.points.push_back(result.probability);
  });
  return voxels;
}

// What the voxels hold, point by point.
void check_voxels(const Cloud& cloud, const Voxels& voxels) {
  std::map<CellCoord, float> expected;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.positions[i].allFinite()) continue;
    const CellCoord voxel = voxels.lattice.grid.cell_of(cloud.positions[i]);
    const auto [found, is_new] = expected.emplace(voxel, voxels.points[i]);
    found->second = std::max(found->second, voxels.points[i]);
  }
  CHECK(voxels.repeated == 0);
  CHECK(voxels.lattice.voxels == voxels.values.size());
  CHECK(voxels.lattice.points_left_out == 0);
  CHECK((voxels.values == expected));
}

TEST_CASE("each voxel has the largest probability of its points, and each finite point has a voxel") {
  const Cloud holes = plane(60).punched({30, 30}, 6);
  for (const Cloud& cloud : {holes, holes.scaled(0x1p-10).translated({500'000, 5.4e6, 300}),
                             random_cloud(3).joined(coincident(40)), plane(25).scaled(1e-12),
                             plane(25).scaled(1e100), coincident(5), Cloud{}}) {
    const Voxels voxels = voxels_of(cloud, tiled({}, 300));
    check_voxels(cloud, voxels);
    if (voxels.mean_edge_length > 0) {
      CHECK(voxels.lattice.grid.edge() <= 1.5 * voxels.mean_edge_length);
      CHECK(voxels.lattice.grid.edge() > voxels.mean_edge_length / 4);
    }
  }
  CHECK(voxels_of(holes).values.size() > 800);
}

TEST_CASE("strays are left out of the grid, and counted") {
  const Cloud surface = plane(90);
  const Voxels voxels = voxels_of(surface.joined(scattered(5, 1).scaled(1e9).translated({1e7, 1e7, 1e7})));
  CHECK(voxels.lattice.points_left_out == 5);
  CHECK(voxels.lattice.grid.shift == 0);
  CHECK(voxels.values.size() > surface.size() / 5);
}

// Places so far apart that each has nodes of its own in OpenVDB's tree.
TEST_CASE(
    "voxels double until OpenVDB's tree takes at most 128 MiB, and merge with the largest probability") {
  Cloud places;
  for (int x = 0; x < 30; ++x) {
    for (int y = 0; y < 30; ++y) places = places.joined(plane(5).translated({x * 5000.0, y * 5000.0, 0}));
  }
  const Voxels voxels = voxels_of(places, tiled({}, 3000));
  check_voxels(places, voxels);
  CHECK(voxels.lattice.grid.shift > 0);
  CHECK(voxels.lattice.grid.shift <= 3);
  CHECK((voxels_of(places, tiled({}, 500, 4)).values == voxels.values));
}

}  // namespace
}  // namespace lacuna
