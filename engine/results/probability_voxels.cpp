// SPDX-License-Identifier: Apache-2.0
#include "engine/results/probability_voxels.hpp"

#include "engine/store/column_writer.hpp"
#include "engine/store/openvdb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{128} << 20;

using Tree = openvdb::FloatTree;
using Upper = Tree::RootNodeType::ChildNodeType;
using Lower = Upper::ChildNodeType;
using Leaf = Tree::LeafNodeType;

// Holds the largest probability in each voxel. While the tree takes more than `most_bytes`, voxels double,
// and merge. More voxels never take fewer nodes, so the order of the voxels does not change the result.
class MergingVoxels {
 public:
  explicit MergingVoxels(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  // `voxel`: a voxel of the finest size.
  void add(const CellCoord& voxel, float probability) {
    raise({voxel[0] >> doublings_, voxel[1] >> doublings_, voxel[2] >> doublings_}, probability);
    while (bytes_ > most_bytes_ && doublings_ < kMostDoublings) merge();
  }
  int doublings() const { return doublings_; }
  const Tree& tree() const { return *tree_; }

 private:
  static constexpr int kMostDoublings = 24;

  void raise(const openvdb::Coord& coord, float probability) {
    if (tree_->probeConstLeaf(coord) == nullptr) {
      bytes_ += sizeof(Leaf) + Leaf::SIZE * sizeof(float);
      if (tree_->probeConstNode<Lower>(coord) == nullptr) bytes_ += sizeof(Lower);
      if (tree_->probeConstNode<Upper>(coord) == nullptr) bytes_ += sizeof(Upper);
    }
    tree_->setValueOn(coord, std::max(tree_->getValue(coord), probability));
  }
  void merge() {
    const auto smaller = std::exchange(tree_, std::make_unique<Tree>(0.0F));
    bytes_ = 0;
    ++doublings_;
    for (auto voxel = smaller->cbeginValueOn(); voxel; ++voxel) raise(voxel.getCoord() >> 1, *voxel);
  }

  std::uint64_t most_bytes_, bytes_ = 0;
  int doublings_ = 0;
  std::unique_ptr<Tree> tree_ = std::make_unique<Tree>(0.0F);
};

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

// Returns the lattice with the coordinates that the voxels get in the end.
CellGrid final_lattice(CellGrid grid, int doublings) {
  grid.shift = doublings;
  for (double& origin : grid.origin) origin += std::ldexp(shift_of(doublings), doublings);
  return grid;
}

// Returns the voxel of each point in `box`. Voxels without end have no place in a grid of OpenVDB.
std::vector<ProbabilityVoxel> voxels_of(const std::vector<StoredPoint>& points,
                                        const std::vector<float>& probabilities, const CellGrid& grid,
                                        const Eigen::AlignedBox3d& box) {
  std::vector<ProbabilityVoxel> voxels;
  voxels.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CellCoord voxel = grid.cell_of(points[i].position());
    if (box.contains(points[i].position()) && !grid.is_endless(voxel))
      voxels.push_back({voxel, probabilities[i]});
  }
  return voxels;
}

constexpr RecordStream<float> kProbabilities{"probabilities"};  // of all points of a tile

}  // namespace

void emit_probabilities(const EvaluatedTile& tile, TileOutput& output) {
  std::vector<float> probabilities(tile.points.owned);
  for (LocalIndex p = 0; p < tile.points.owned; ++p) probabilities[p] = tile.probability(p);
  output.add(kProbabilities, std::move(probabilities));
}

ProbabilityGrid probability_voxels(const TileOutputs& outputs, double typical_distance,
                                   const Eigen::AlignedBox3d& box, const TileStore& store, Job& job) {
  const Tiling& tiling = store.tiling();
  Phase phase(job, "voxels", tiling.points());
  const Eigen::Vector3d middle = box.isEmpty() ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(box.center());
  const CellGrid finest = finest_lattice(typical_distance > 0 ? std::ilogb(typical_distance) : 0, middle);
  std::vector<std::uint64_t> needs;
  for (const Tile& tile : tiling.tiles) needs.push_back(tile.points * 64);
  std::mutex mutex;
  ProbabilityGrid grid{{}, Column<ProbabilityVoxel>(job.file("voxels"))};
  const MemoryLedger::Lease tree = job.ledger.take(std::min(kMostBytes, job.memory.work / 8 * 7));
  MergingVoxels merging(tree.bytes());
  job.for_each_within(job.memory.work / 8, needs, [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    const Tile& tile = tiling.tiles[t];
    const std::vector<ProbabilityVoxel> voxels =
        voxels_of(store.points(t), outputs.read(kProbabilities, t), finest, box);
    const std::lock_guard lock(mutex);
    for (const ProbabilityVoxel& voxel : voxels) merging.add(voxel.coord, voxel.probability);
    grid.lattice.points_left_out += tile.points - voxels.size();
    phase.advance(tile.points);
  });

  const std::int32_t shift = shift_of(merging.doublings());
  grid.lattice.grid = final_lattice(finest, merging.doublings());
  grid.lattice.voxels = merging.tree().activeVoxelCount();
  ColumnWriter<ProbabilityVoxel> writer(grid.voxels);
  for (auto voxel = merging.tree().cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Coord coord = voxel.getCoord();
    writer.add({{coord[0] - shift, coord[1] - shift, coord[2] - shift}, *voxel});
  }
  writer.finish();
  return grid;
}

}  // namespace lacuna
