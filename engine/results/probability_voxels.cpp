// SPDX-License-Identifier: Apache-2.0
#include "engine/results/probability_voxels.hpp"

#include "engine/results/voxel_sizes.hpp"
#include "engine/store/column_writer.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{128} << 20;

// A voxel of the finest size, and the points of one tile in it.
struct TileVoxel {
  CellCoord coord{};
  float probability = 0;
  std::uint32_t points = 0;
};

struct AlongZ {
  bool operator()(const TileVoxel& a, const TileVoxel& b) const {
    return comes_before_along_z(a.coord, b.coord);
  }
};

// Voxels in any order of equal ones have the same largest probability and the same number of points.
using VoxelSort = SortedRuns<TileVoxel, AlongZ>;

// Returns the shift of doubled voxels; the middle is within the first node of 4096^3 voxels after it.
std::int32_t shift_of(int doublings) {
  return (CellGrid::kMiddle >> doublings) / 4096 * 4096;
}

CellGrid finest_lattice(int exponent, const Eigen::Vector3d& middle) {
  // No voxel is smaller than the last digit of the coordinates.
  const double far = middle.cwiseAbs().maxCoeff();
  const int digit = far > 0 ? std::ilogb(far) - std::numeric_limits<double>::digits : -500;
  return CellGrid::around(middle, std::clamp(exponent, std::max(digit, -500), 500));
}

// The lattice with the coordinates that the voxels get in the end.
CellGrid final_lattice(CellGrid grid, int doublings) {
  grid.shift = doublings;
  for (double& origin : grid.origin) origin += std::ldexp(shift_of(doublings), doublings);
  return grid;
}

// The voxels of one tile, each once. Voxels without end have no place in a grid of OpenVDB: their points are
// left out.
std::vector<TileVoxel> voxels_of(const std::vector<StoredPoint>& points,
                                 const std::vector<float>& probabilities, const CellGrid& grid) {
  std::vector<TileVoxel> voxels;
  voxels.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CellCoord voxel = grid.cell_of(points[i].position());
    if (!grid.is_endless(voxel)) voxels.push_back({voxel, probabilities[i], 1});
  }
  std::sort(voxels.begin(), voxels.end(), AlongZ());
  std::size_t kept = 0;
  for (const TileVoxel& voxel : voxels) {
    if (kept > 0 && same_cell(voxels[kept - 1].coord, voxel.coord)) {
      TileVoxel& same = voxels[kept - 1];
      same.probability = std::max(same.probability, voxel.probability);
      ++same.points;
    } else {
      voxels[kept++] = voxel;
    }
  }
  voxels.resize(kept);
  return voxels;
}

// visit(voxel), each once, along the Z curve, after `doublings`; coordinates still those of `sort`, divided.
template <class Visit>
void for_each_voxel(VoxelSort& sort, int doublings, Visit&& visit) {
  struct Large {
    CellCoord coord;
    float probability;
    std::uint64_t points;
  };
  std::optional<Large> last;
  sort.for_each([&](const TileVoxel& small) {
    const CellCoord coord = {small.coord[0] >> doublings, small.coord[1] >> doublings,
                             small.coord[2] >> doublings};
    if (last && same_cell(last->coord, coord)) {
      last->probability = std::max(last->probability, small.probability);
      last->points += small.points;
      return;
    }
    if (last) visit(*last);
    last = Large{coord, small.probability, small.points};
  });
  if (last) visit(*last);
}

// An exponent of mean distances to the neighbours, and how many points of a tile have it.
struct DistanceExponent {
  std::int64_t exponent;
  std::uint64_t points;
};

constexpr RecordStream<float> kProbabilities{"probabilities"};
constexpr RecordStream<DistanceExponent> kExponents{"exponents"};

// Returns the exponent of the median; 0 without any.
int typical_exponent(const TileOutputs& outputs, std::size_t tiles) {
  std::map<std::int64_t, std::uint64_t> exponents;
  std::uint64_t all = 0, before = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    for (const auto& [exponent, points] : outputs.read(kExponents, static_cast<TileIndex>(t))) {
      exponents[exponent] += points;
      all += points;
    }
  }
  for (const auto& [exponent, points] : exponents) {
    before += points;
    if (2 * before >= all) return static_cast<int>(exponent);
  }
  return 0;
}

}  // namespace

void emit_probabilities(const EvaluatedTile& tile, TileOutput& output) {
  std::vector<float> probabilities(tile.points.owned);
  for (LocalIndex p = 0; p < tile.points.owned; ++p) probabilities[p] = tile.probability(p);
  output.add(kProbabilities, probabilities);

  std::map<std::int64_t, std::uint64_t> exponents;
  for (const Evaluation& e : tile.evaluations) {
    if (e.mean_distance > 0 && std::isfinite(e.mean_distance)) ++exponents[std::ilogb(e.mean_distance)];
  }
  std::vector<DistanceExponent> counts;
  for (const auto& [exponent, points] : exponents) counts.push_back({exponent, points});
  output.add(kExponents, counts);
}

ProbabilityGrid probability_voxels(const TileOutputs& outputs, const TileStore& store,
                                   const Eigen::Vector3d& middle, Job& job) {
  const Tiling& tiling = store.tiling();
  Phase phase(job, "voxels", tiling.points());
  const CellGrid finest = finest_lattice(typical_exponent(outputs, tiling.tiles.size()), middle);
  VoxelSort sort(job.file("voxel-sort"), job.memory.global / 3);
  std::mutex mutex;
  std::vector<std::uint64_t> needs;
  for (const Tile& tile : tiling.tiles) needs.push_back(tile.points * 64);
  job.arena.for_each_within_budget(needs, job.memory.tiles, [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    const Tile& tile = tiling.tiles[t];
    const std::vector<TileVoxel> voxels = voxels_of(store.points(t), outputs.read(kProbabilities, t), finest);
    const std::lock_guard lock(mutex);
    sort.add(voxels);
    phase.advance(tile.points);
  });

  std::uint64_t placed = 0;
  VoxelSizes sizes(tiling.points());
  for_each_voxel(sort, 0, [&](const auto& voxel) {
    sizes.add(voxel.coord, voxel.points);
    placed += voxel.points;
  });
  sizes.finish();
  const int doublings = sizes.doublings_within(std::min(kMostBytes, job.memory.global));

  const std::int32_t shift = shift_of(doublings);
  ProbabilityGrid grid{{.grid = final_lattice(finest, doublings)},
                       Column<ProbabilityVoxel>(job.file("voxels"))};
  grid.lattice.points_left_out = tiling.points() - placed;
  ColumnWriter<ProbabilityVoxel> writer(grid.voxels);
  std::span<const CellCoord> nodes = sizes.kept_nodes(doublings);
  for_each_voxel(sort, doublings, [&](const auto& voxel) {
    const CellCoord node = VoxelSizes::node_of(voxel.coord, 0);
    while (!nodes.empty() && comes_before_along_z(nodes.front(), node)) nodes = nodes.subspan(1);
    if (nodes.empty() || !same_cell(nodes.front(), node)) {
      grid.lattice.points_left_out += voxel.points;
      return;
    }
    ++grid.lattice.voxels;
    writer.add({{voxel.coord[0] - shift, voxel.coord[1] - shift, voxel.coord[2] - shift}, voxel.probability});
  });
  writer.finish();
  return grid;
}

}  // namespace lacuna
