// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/choose_points.hpp"

#include "engine/model/distance_bound.hpp"
#include "engine/run/error.hpp"
#include "engine/store/outbox.hpp"
#include "engine/thin/lattice.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <span>
#include <sstream>
#include <tuple>

namespace lacuna {
namespace {

constexpr std::uint64_t kBytesPerPoint = 128;  // of a tile, with its cells

// The occupied cells of some points in a hash table, each with the point that represents it.
class OccupiedCells {
 public:
  OccupiedCells(std::vector<StoredPoint> points, double edge)
      : lattice_(edge),
        edge_(edge),
        points_(std::move(points)),
        slots_(std::bit_ceil(2 * points_.size() + 1)) {
    cells_.reserve(points_.size());
    for (LocalIndex p = 0; p < points_.size(); ++p) add(p);
  }

  // Calls visit(index) for each point that represents its cell.
  template <class Visit>
  void for_each_representative(Visit&& visit) const {
    for (const Cell& cell : cells_) visit(cell.representative);
  }

  std::span<const StoredPoint> points() const { return points_; }
  // Returns null where no point is in the cell of this one.
  const StoredPoint* representative_of(const StoredPoint& point) const {
    const std::uint32_t slot = slots_[slot_of(place_of(point))];
    return slot == 0 ? nullptr : &points_[cells_[slot - 1].representative];
  }
  // Returns whether one of the points comes before this one in its cell.
  bool has_better(const StoredPoint& point) const {
    const LatticePlace place = place_of(point);
    const std::uint32_t slot = slots_[slot_of(place)];
    return slot != 0 && !comes_first(place.squared_offset, point, cells_[slot - 1]);
  }

 private:
  struct Cell {
    Eigen::Vector3d cell;
    double squared_offset;  // of the representative
    LocalIndex representative;
  };

  void add(LocalIndex p) {
    const LatticePlace place = place_of(points_[p]);
    std::uint32_t& slot = slots_[slot_of(place)];
    if (slot == 0) {
      cells_.push_back({place.cell, place.squared_offset, p});
      slot = static_cast<std::uint32_t>(cells_.size());
    } else if (comes_first(place.squared_offset, points_[p], cells_[slot - 1])) {
      cells_[slot - 1].squared_offset = place.squared_offset;
      cells_[slot - 1].representative = p;
    }
  }

  bool comes_first(double squared_offset, const StoredPoint& p, const Cell& cell) const {
    if (squared_offset != cell.squared_offset) return squared_offset < cell.squared_offset;
    const StoredPoint& q = points_[cell.representative];
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  }

  // Returns the slot with this cell, or the empty slot where it belongs.
  std::size_t slot_of(const LatticePlace& place) const {
    std::size_t slot = (place.hash >> 32) & (slots_.size() - 1);
    while (slots_[slot] != 0 && cells_[slots_[slot] - 1].cell != place.cell)
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  LatticePlace place_of(const StoredPoint& point) const {
    const LatticePlace place = lattice_.place_of(point.position());
    if (place.cell.allFinite()) return place;
    std::ostringstream message;
    message << "point " << value(point.id) << " at " << point.position().transpose()
            << " is too far away for a resolution of " << edge_ << ": a larger one is needed";
    throw Error(message.str());
  }

  Lattice lattice_;
  double edge_;
  std::vector<StoredPoint> points_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> slots_;  // one more than a cell's index; 0: no cell. A power of two
};

// Two points of one cell are no farther apart than its diagonal and the error of rounding.
double squared_reach(const Eigen::AlignedBox3d& box, double edge) {
  const double farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double side = edge * (1 + 1e-12) + farthest * 1e-15;
  return 3 * side * side;
}

class Chooser {
 public:
  Chooser(const TileStore& store, double edge, ChosenPoints& chosen)
      : store_(store), tiling_(store.tiling()), edge_(edge), lattice_(edge), chosen_(chosen) {}

  // First, each tile chooses alone.
  void choose_within(TileIndex t) {
    const Tile& tile = tiling_.tiles[t];
    OccupiedCells(store_.points(t), edge_).for_each_representative([&](LocalIndex p) {
      chosen_.rows.insert(tile.row(p));
    });
    count(t);
  }

  // Then, where cells reach into other tiles, only the best of all is left. Tiles may run in any order and at
  // the same time: the best of a cell is never erased, and beats all others.
  void erase_beaten(TileIndex t) {
    const OccupiedCells others(others_in_cells_of(t), edge_);
    if (others.points().empty()) return;
    for_each_chosen(t, [&](Row row, const StoredPoint& p) {
      if (others.has_better(p)) chosen_.rows.erase(row);
    });
  }

  // Counts how many points are left in each cell of the store; returns their sum.
  std::uint64_t count(TileIndex t) {
    const Tile& tile = tiling_.tiles[t];
    std::uint64_t sum = 0;
    for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell; ++cell) {
      std::uint32_t in_cell = 0;
      for_each_row(cell, [&](Row row) { in_cell += chosen_.rows.contains(row); });
      chosen_.in_cell[cell] = in_cell;
      sum += in_cell;
    }
    return sum;
  }

  // Last, it finds which point represents each of the tile's points, and their copies.
  void send_represented(TileIndex t) {
    std::vector<StoredPoint> points = store_.points(t);
    const std::size_t owned = points.size();
    const std::vector<StoredPoint> others = others_in_cells_of(t);
    points.insert(points.end(), others.begin(), others.end());
    const OccupiedCells cells(std::move(points), edge_);
    Outbox<Represented> outbox(*chosen_.represented);
    const auto send = [&](LocalIndex point, PointId id) {
      const PointId representative = cells.representative_of(cells.points()[point])->id;
      outbox.add(static_cast<TileIndex>(value(representative) / kRepresentedBlock), {representative, id});
    };
    for (LocalIndex p = 0; p < owned; ++p) send(p, cells.points()[p].id);
    store_.for_each_duplicate(t, [&](const Duplicate& copy) { send(copy.of, copy.id); });
    outbox.send();
  }

 private:
  template <class Visit>
  void for_each_row(std::uint32_t cell, Visit&& visit) const {
    const std::uint64_t first = value(tiling_.cells[cell].first_row);
    for (std::uint64_t row = first; row < first + tiling_.cells[cell].points; ++row) visit(Row{row});
  }

  // Calls visit(row, point) for points of a tile that are chosen so far.
  template <class Visit>
  void for_each_chosen(TileIndex t, Visit&& visit) const {
    LocalIndex owned = 0;
    store_.for_each_point(t, [&](const StoredPoint& p) {
      const Row row = tiling_.tiles[t].row(owned++);
      if (chosen_.rows.contains(row)) visit(row, p);
    });
  }

  // Returns chosen points of other tiles that may lie in cells of this tile's points.
  std::vector<StoredPoint> others_in_cells_of(TileIndex t) const {
    const Tile& tile = tiling_.tiles[t];
    Eigen::AlignedBox3d box;
    for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell; ++cell)
      box.extend(tiling_.cells[cell].box);
    const Eigen::Array3d low = cell_of(box.min()), high = cell_of(box.max());
    std::vector<StoredPoint> others;
    for_each_cell_near(
        tiling_, box, squared_reach(box, edge_), tile.first_cell, tile.last_cell, [&](std::uint32_t cell) {
          if (chosen_.in_cell[cell] == 0) return true;
          const Eigen::AlignedBox3d& of_cell = tiling_.cells[cell].box;
          if ((cell_of(of_cell.max()) < low).any() || (cell_of(of_cell.min()) > high).any()) return true;
          std::uint64_t row = value(tiling_.cells[cell].first_row);
          for (const StoredPoint& p : store_.cell(cell)) {
            const Eigen::Array3d of_point = cell_of(p.position());
            if (chosen_.rows.contains(Row{row++}) && (of_point >= low).all() && (of_point <= high).all())
              others.push_back(p);
          }
          return true;
        });
    return others;
  }

  // In whole numbers: monotone along each axis.
  Eigen::Array3d cell_of(const Eigen::Vector3d& position) const { return lattice_.place_of(position).cell; }

  const TileStore& store_;
  const Tiling& tiling_;
  double edge_;
  Lattice lattice_;
  ChosenPoints& chosen_;
};

}  // namespace

ChosenPoints choose_points(const TileStore& store, double edge, std::uint64_t represented_ids, Job& job) {
  const Tiling& tiling = store.tiling();
  ChosenPoints chosen{.rows = RowSet(tiling.row_count()),
                      .in_cell = std::vector<std::uint32_t>(tiling.cells.size()),
                      .represented = {}};
  if (represented_ids > 0)
    chosen.represented.emplace(job.file("represented"), represented_ids / kRepresentedBlock + 1, job.lists);
  std::vector<std::uint64_t> needs;
  for (const Tile& tile : tiling.tiles) needs.push_back(tile.points * kBytesPerPoint);
  const auto for_each_tile = [&](auto&& take) {
    job.for_each_within(job.memory.tiles, needs, [&](std::size_t t) { take(static_cast<TileIndex>(t)); });
  };
  Chooser chooser(store, edge, chosen);
  for_each_tile([&](TileIndex t) { chooser.choose_within(t); });
  for_each_tile([&](TileIndex t) { chooser.erase_beaten(t); });
  std::atomic<std::uint64_t> count = 0;
  for_each_tile([&](TileIndex t) { count += chooser.count(t); });
  chosen.count = count;
  if (chosen.represented) for_each_tile([&](TileIndex t) { chooser.send_represented(t); });
  return chosen;
}

}  // namespace lacuna
