// What the evaluation of a tile hands on. Each consumer keeps what it needs in lists of its own, and nothing
// else of the tile stays: the neighbour graph never touches the disk.
#pragma once

#include "engine/criteria/evaluation.hpp"
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

class TileConsumer {
 public:
  virtual ~TileConsumer() = default;
  // Called once for each tile, in any order, from several threads at once.
  virtual void take(const EvaluatedTile& tile) = 0;
};

// Writes record(p) for the owned points that are wanted. They are few and near each other, so runs of rows
// without any stay unwritten.
template <class Record, class Make>
void write_wanted(Column<Record>& column, const EvaluatedTile& tile, std::span<const std::uint8_t> is_wanted,
                  Make&& record) {
  constexpr LocalIndex kRun = 64;
  std::vector<Record> records;
  const auto write = [&](LocalIndex end) {
    if (!records.empty()) column.write(value(tile.tile.first_row) + end - records.size(), records);
    records.clear();
  };
  for (LocalIndex begin = 0, end; begin < tile.points.owned; begin = end) {
    end = std::min(begin + kRun, tile.points.owned);
    if (std::any_of(is_wanted.begin() + begin, is_wanted.begin() + end, [](bool wanted) { return wanted; })) {
      for (LocalIndex p = begin; p < end; ++p) records.push_back(record(p));
    } else {
      write(begin);
    }
  }
  write(tile.points.owned);
}

}  // namespace lacuna
