// SPDX-License-Identifier: Apache-2.0
#include "bench/sample.hpp"

#include "bench/synth/permutation.hpp"
#include "bench/synth/random.hpp"
#include "engine/bucket/cell_index.hpp"
#include "engine/bucket/order_tile.hpp"
#include "engine/bucket/split.hpp"
#include "engine/survey/survey.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace lacuna {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kJitter = 0.25;         // of the spacing
constexpr std::uint32_t kHoleCell = 64;  // nodes
constexpr double kLeastHole = 4, kMostHole = 12;

// Places one hole somewhere in each cell of nodes, wholly inside it.
bool in_hole(std::uint32_t row, std::uint32_t column) {
  const synth::Random random(kSeed, 1);
  const std::uint64_t cell = std::uint64_t{row / kHoleCell} << 32 | column / kHoleCell;
  const double radius = random.uniform(3 * cell, kLeastHole, kMostHole);
  const double margin = radius + 2;
  const double across = random.uniform(3 * cell + 1, margin, kHoleCell - margin) - column % kHoleCell;
  const double down = random.uniform(3 * cell + 2, margin, kHoleCell - margin) - row % kHoleCell;
  return across * across + down * down < radius * radius;
}

// Nodes (u, v) in the unit square go to exp(ln 2 (u + i v)). Angles stay, and the spacing grows with u from 1
// to 2 times the smallest.
Eigen::Vector3d place(double u, double v) {
  const double distance = std::exp2(u), angle = std::numbers::ln2 * v;
  const double x = distance * std::cos(angle), y = distance * std::sin(angle);
  return Eigen::Vector3d(x, y, 0.05 * std::sin(9 * x) * std::cos(7 * y)).cast<float>().cast<double>();
}

}  // namespace

PointBatch sample_surface(std::uint32_t points, SampleOrder order) {
  const synth::Random random(kSeed, 2);
  const auto columns =
      static_cast<std::uint32_t>(std::ceil(std::sqrt(1.1 * points)));  // a tenth for the holes
  PointBatch batch;
  batch.positions.resize(points);
  const synth::Permutation shuffled(points, kSeed);
  std::uint64_t count = 0;
  for (std::uint64_t node = 0; count < points; ++node) {
    const auto row = static_cast<std::uint32_t>(node / columns),
               column = static_cast<std::uint32_t>(node % columns);
    if (in_hole(row, column)) continue;
    const double u = column + random.uniform(2 * node, -kJitter, kJitter);
    const double v = row + random.uniform(2 * node + 1, -kJitter, kJitter);
    const std::uint64_t id = order == SampleOrder::kRandom ? shuffled(count) : count;
    batch.positions[id] = place(u / columns, v / columns);
    ++count;
  }
  return batch;
}

TilePoints sample_tile(const PointBatch& batch) {
  constexpr std::uint64_t kMemory = std::uint64_t{1} << 30;
  constexpr std::uint64_t kCellPoints = 32;
  Survey survey(kMemory, batch.size());
  survey.add(batch);
  SurveyedScan surveyed = survey.finish();
  const TilePlan plan = split_tiles(std::move(surveyed.cells), surveyed.grid, batch.size(), batch.size());
  std::vector<std::uint32_t> cells(batch.size());
  CellIndex(plan.grid, plan.cells).find(batch.positions, cells);

  std::vector<StoredPoint> stored;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const Eigen::Vector3d& p = batch.positions[i];
    stored.push_back({p.x(), p.y(), p.z(), PointId{i}});
  }
  const OrderedTile ordered = order_tile(stored, cells, plan.cells.size(), plan.grid, kCellPoints);

  TilePoints tile;
  for (const std::uint32_t i : ordered.order) {
    tile.rows.push_back(Row{tile.rows.size()});
    tile.ids.push_back(stored[i].id);
    tile.positions.push_back(stored[i].position());
  }
  tile.owned = static_cast<LocalIndex>(tile.size());
  tile.linked.offsets.assign(tile.owned + 1, 0);
  return tile;
}

}  // namespace lacuna
