// SPDX-License-Identifier: Apache-2.0
#include "engine/results/probability_voxels.hpp"

#include "engine/pipeline.hpp"
#include "engine/results/voxel_sizes.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
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

TEST_CASE("voxels are the same for every tiling, number of threads and memory limit") {
  const Cloud cloud = plane(90).punched({30, 30}, 6).joined(scattered(200, 1).scaled(1e4)).shuffled(2);
  const Voxels one = voxels_of(cloud, tiled({}, 100'000, 1));
  for (const auto& [tile_points, threads, limit] :
       {std::array<std::int64_t, 3>{300, 4, 0}, {1000, 1, 64 << 20}, {100'000, 2, 64 << 20}}) {
    Config config = tiled({}, tile_points, threads);
    config.run.memory_limit = static_cast<std::uint64_t>(limit);
    const Voxels other = voxels_of(cloud, config);
    CHECK((other.values == one.values));
    CHECK(other.lattice.grid.shift == one.lattice.grid.shift);
    CHECK(other.lattice.grid.finest == one.lattice.grid.finest);
    CHECK(other.lattice.grid.origin == one.lattice.grid.origin);
    CHECK(other.lattice.points_left_out == one.lattice.points_left_out);
  }
}

TEST_CASE("points far from all others are left out of the grid, and counted") {
  const Cloud surface = plane(90);
  const Voxels voxels = voxels_of(surface.joined(scattered(20, 1).scaled(1e9).translated({1e7, 1e7, 1e7})));
  CHECK(voxels.lattice.points_left_out >= 18);
  CHECK(voxels.lattice.points_left_out <= 20);
  CHECK(voxels.lattice.grid.shift == 0);
  CHECK(voxels.values.size() > surface.size() / 5);
}

// A sheet of voxels, along the Z curve.
std::vector<CellCoord> sheet(std::int32_t side) {
  std::vector<CellCoord> voxels;
  for (std::int32_t x = 0; x < side; ++x) {
    for (std::int32_t y = 0; y < side; ++y) voxels.push_back({x - side / 3, y - 7, (x + y) / 9});
  }
  std::sort(voxels.begin(), voxels.end(), comes_before_along_z);
  return voxels;
}

std::uint64_t tree_bytes(const std::vector<CellCoord>& voxels, int doublings) {
  std::set<CellCoord> leaves, lowers, uppers;
  for (const CellCoord& v : voxels) {
    const auto node = [&](int bits) {
      bits += doublings;
      return CellCoord{v[0] >> bits, v[1] >> bits, v[2] >> bits};
    };
    leaves.insert(node(3));
    lowers.insert(node(7));
    uppers.insert(node(12));
  }
  return leaves.size() * 2'150 + lowers.size() * 33'900 + uppers.size() * 270'500;
}

TEST_CASE("voxels double just until OpenVDB's tree takes no more memory than allowed") {
  const std::vector<CellCoord> voxels = sheet(700);
  VoxelSizes sizes(voxels.size());
  for (const CellCoord& voxel : voxels) sizes.add(voxel, 1);
  sizes.finish();
  for (const std::uint64_t bytes : {100'000'000, 12'000'000, 4'000'000, 2'000'000}) {
    const int doublings = sizes.doublings_within(bytes);
    INFO(bytes << " bytes, " << doublings << " doublings");
    CHECK(tree_bytes(voxels, doublings) < bytes * 1.02);
    if (doublings > 0) CHECK(tree_bytes(voxels, doublings - 1) > bytes * 0.98);
  }
  CHECK(sizes.doublings_within(100'000'000) == 0);
  CHECK(sizes.doublings_within(4'000'000) > 0);
  CHECK(sizes.doublings_within(0) == VoxelSizes::kMostDoublings);
}

TEST_CASE("the Z curve keeps voxels in order when their size doubles") {
  Random random(5);
  std::vector<CellCoord> voxels;
  for (int i = 0; i < 2000; ++i) {
    const auto at = [&] {
      return static_cast<std::int32_t>(random.whole(-3000, 3000)) * (random.chance(0.1) ? 100'000 : 1);
    };
    voxels.push_back({at(), at(), at()});
  }
  std::sort(voxels.begin(), voxels.end(), comes_before_along_z);
  for (int bits = 1; bits < 20; ++bits) {
    for (CellCoord& voxel : voxels) voxel = {voxel[0] >> 1, voxel[1] >> 1, voxel[2] >> 1};
    CHECK(std::is_sorted(voxels.begin(), voxels.end(), comes_before_along_z));
  }
}

}  // namespace
}  // namespace lacuna
