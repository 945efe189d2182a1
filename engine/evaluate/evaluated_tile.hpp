// SPDX-License-Identifier: Apache-2.0
// What the evaluation of a tile hands on, and who takes it.
#pragma once

#include "engine/criteria/evaluation.hpp"
#include "engine/evaluate/tile_output.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/model/tiling.hpp"
#include "engine/store/column.hpp"
#include "engine/store/point_column.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

struct EvaluatedTile {
  TileIndex index;
  const Tile& tile;
  const TilePoints& points;
  const Neighbourhoods& neighbourhoods;     // of owned points
  std::span<const Evaluation> evaluations;  // likewise
  std::span<const double> criteria;  // likewise, side by side in the order of the table; empty: not wanted
  std::span<const LocalIndex> candidates;   // owned points with Pi above the threshold, ascending
  std::span<const std::uint8_t> is_border;  // of owned points: has foreign neighbours

  Vertex vertex(LocalIndex p) const { return {points.ids[p], points.rows[p]}; }
  StoredPoint stored(LocalIndex p) const {
    const Eigen::Vector3d& x = points.positions[p];
    return {x.x(), x.y(), x.z(), points.ids[p]};
  }
  float probability(LocalIndex p) const { return static_cast<float>(evaluations[p].probability); }
};

// A consumer takes each tile in two steps. `emit` needs the evaluated tile, `absorb` only what was put out. An
// earlier run may have put it out. Both are called from several threads at once, for tiles in any order.
// `absorb` is called once for each tile.
class TileConsumer {
 public:
  virtual ~TileConsumer() = default;
  virtual void emit(const EvaluatedTile& tile, TileOutput& output) const = 0;
  virtual void absorb(TileIndex tile, const TileOutput& output) = 0;
};

// Writes records of some of a tile's points, given by ascending index, to their rows. Points near each other
// are one write: rows between them get zeros.
template <class Record>
void write_rows(Column<Record>& column, const Tile& tile, std::span<const LocalIndex> points,
                std::span<const Record> records) {
  constexpr LocalIndex kNear = 64;
  std::vector<Record> run;
  for (std::size_t i = 0; i < points.size(); ++i) {
    run.push_back(records[i]);
    if (i + 1 < points.size() && points[i + 1] - points[i] < kNear) {
      run.resize(run.size() + (points[i + 1] - points[i] - 1));
      continue;
    }
    column.write(value(tile.row(points[i])) + 1 - run.size(), run);
    run.clear();
  }
}

}  // namespace lacuna
