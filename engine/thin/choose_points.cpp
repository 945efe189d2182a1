// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/choose_points.hpp"

#include "engine/model/distance_bound.hpp"
#include "engine/run/error.hpp"
#include "engine/store/append_lists.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <sstream>
#include <tuple>

namespace lacuna {
namespace {

// The finaliser of MurmurHash3, for each coordinate in turn.
std::uint64_t mixed(std::uint64_t hash, double coordinate) {
  hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * 0xff51afd7ed558ccdULL;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return hash ^ (hash >> 33);
}

constexpr std::uint64_t kBytesPerPoint = 128;  // of a tile, with its cells

// The occupied cells of a tile in a hash table, each with the point that represents it.
class OccupiedCells {
 public:
  OccupiedCells(std::vector<ScanPoint> points, double edge)
      : lattice_(edge),
        edge_(edge),
        points_(std::move(points)),
        owned_(points_.size()),
        slots_(std::bit_ceil(2 * points_.size() + 1)) {
    cells_.reserve(owned_);
    for (LocalIndex p = 0; p < owned_; ++p) add(p);
  }

  // Compares a point of another tile with the representative of its cell, if there is one.
  void compare(const ScanPoint& point) {
    const PointInCell place = place_of(point);
    const std::uint32_t slot = slots_[slot_of(place)];
    if (slot == 0 || !comes_first(place.squared_offset, point, cells_[slot - 1])) return;
    cells_[slot - 1].squared_offset = place.squared_offset;
    cells_[slot - 1].representative = static_cast<LocalIndex>(points_.size());
    points_.push_back(point);
  }

  // Calls visit(index) for each point of the tile that represents its cell.
  template <class Visit>
  void for_each_representative(Visit&& visit) const {
    for (const Cell& cell : cells_) {
      if (cell.representative < owned_) visit(cell.representative);
    }
  }

  std::span<const ScanPoint> points() const { return std::span(points_).first(owned_); }  // of the tile
  const ScanPoint& representative_of(const ScanPoint& point) const {  // which is one of the tile
    return points_[cells_[slots_[slot_of(place_of(point))] - 1].representative];
  }

 private:
  struct Cell {
    Eigen::Vector3d cell;
    double squared_offset;  // of the representative
    LocalIndex representative;
  };

  void add(LocalIndex p) {
    const PointInCell place = place_of(points_[p]);
    std::uint32_t& slot = slots_[slot_of(place)];
    if (slot == 0) {
      cells_.push_back({place.cell, place.squared_offset, p});
      slot = static_cast<std::uint32_t>(cells_.size());
    } else if (comes_first(place.squared_offset, points_[p], cells_[slot - 1])) {
      cells_[slot - 1].squared_offset = place.squared_offset;
      cells_[slot - 1].representative = p;
    }
  }

  bool comes_first(double squared_offset, const ScanPoint& p, const Cell& cell) const {
    if (squared_offset != cell.squared_offset) return squared_offset < cell.squared_offset;
    const ScanPoint& q = points_[cell.representative];
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  }

  // Returns the slot with this cell, or the empty slot where it belongs.
  std::size_t slot_of(const PointInCell& place) const {
    std::size_t slot = (place.hash >> 32) & (slots_.size() - 1);
    while (slots_[slot] != 0 && cells_[slots_[slot] - 1].cell != place.cell)
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  PointInCell place_of(const ScanPoint& point) const {
    const PointInCell place = lattice_.place_of(point.position());
    if (place.cell.allFinite()) return place;
    std::ostringstream message;
    message << "point " << value(point.id) << " at " << point.position().transpose()
            << " is too far away for a resolution of " << edge_ << ": a larger one is needed";
    throw Error(message.str());
  }

  Lattice lattice_;
  double edge_;
  std::vector<ScanPoint> points_;  // of the tile, and then others that represent a cell
  LocalIndex owned_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> slots_;  // one more than a cell's index; 0: no cell. A power of two
};

// Two points of one cell are no farther apart than its diagonal and the error of rounding.
double squared_reach(const Eigen::AlignedBox3d& box, double edge) {
  const double farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double side = edge * (1 + kBelowOrigin + 1e-12) + farthest * 1e-15;
  return 3 * side * side;
}

// Returns the cells of other tiles whose points may lie in one lattice cell with a point of this tile.
std::vector<std::uint32_t> cells_at_border(const Tiling& tiling, const Tile& tile, double edge) {
  const Lattice lattice(edge);
  const auto place_of = [&](const Eigen::Vector3d& position) -> Eigen::Array3d {
    return lattice.place_of(position).cell;  // in whole numbers: monotone along each axis
  };
  std::vector<std::uint32_t> found;
  for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell; ++cell) {
    const Eigen::AlignedBox3d box = tiling.cells[cell].box;
    for_each_cell_near(tiling, box, squared_reach(box, edge), tile.first_cell, tile.last_cell,
                       [&](std::uint32_t near) {
                         const Eigen::AlignedBox3d other = tiling.cells[near].box;
                         const bool may_share = (place_of(other.max()) >= place_of(box.min())).all() &&
                                                (place_of(other.min()) <= place_of(box.max())).all();
                         if (may_share) found.push_back(near);
                         return true;
                       });
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void choose_in_tile(const TileStore& store, TileIndex t, double edge, ChosenPoints& chosen) {
  const Tiling& tiling = store.tiling();
  const Tile& tile = tiling.tiles[t];
  OccupiedCells cells(store.points(t), edge);
  for (const std::uint32_t cell : cells_at_border(tiling, tile, edge)) {
    for (const ScanPoint& p : store.cell(cell)) cells.compare(p);
  }
  cells.for_each_representative([&](LocalIndex p) { chosen.rows.insert(tile.row(p)); });
  for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell; ++cell) {
    const std::uint64_t first = value(tiling.cells[cell].first_row);
    for (std::uint64_t row = first; row < first + tiling.cells[cell].points; ++row)
      chosen.in_cell[cell] += chosen.rows.contains(Row{row});
  }
  if (!chosen.represented) return;
  Outbox<Represented> outbox(*chosen.represented);
  const auto send = [&](LocalIndex point, PointId id) {
    const PointId representative = cells.representative_of(cells.points()[point]).id;
    outbox.add(static_cast<TileIndex>(value(representative) / kRepresentedBlock), {representative, id});
  };
  for (LocalIndex p = 0; p < cells.points().size(); ++p) send(p, cells.points()[p].id);
  store.for_each_duplicate(t, [&](const Duplicate& copy) { send(copy.of, copy.id); });
  outbox.send();
}

}  // namespace

std::uint64_t hash_of(const Eigen::Vector3d& cell) {
  return mixed(mixed(mixed(0, cell.x()), cell.y()), cell.z());
}

PointInCell Lattice::place_of(const Eigen::Vector3d& position) const {
  PointInCell place{.cell = {}, .squared_offset = 0, .hash = 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double edges = position[axis] * per_length_;
    place.cell[axis] = std::floor(-kBelowOrigin <= edges && edges < 0 ? 0 : edges) + 0.0;  // -0 is 0
    const double offset = edges - place.cell[axis] - 0.5;
    place.squared_offset += offset * offset;
  }
  place.hash = hash_of(place.cell);
  return place;
}

ChosenPoints choose_points(const TileStore& store, const TileRange& tiles, double edge,
                           std::uint64_t represented_ids, const Spill& spill, const Workers& workers) {
  const Tiling& tiling = store.tiling();
  ChosenPoints chosen{.tiles = tiles,
                      .rows = RowSet(tiling.row_count()),
                      .in_cell = std::vector<std::uint32_t>(tiling.cells.size()),
                      .represented = {}};
  if (represented_ids > 0)
    chosen.represented.emplace(spill, "represented", represented_ids / kRepresentedBlock + 1);
  std::vector<std::uint64_t> needs;
  for (TileIndex t = tiles.first; t < tiles.last; ++t)
    needs.push_back(tiling.tiles[t].points * kBytesPerPoint);
  workers.for_each_within(workers.memory.tiles, needs, [&](std::size_t i) {
    choose_in_tile(store, tiles.first + static_cast<TileIndex>(i), edge, chosen);
  });
  chosen.count = std::accumulate(chosen.in_cell.begin(), chosen.in_cell.end(), std::uint64_t{0});
  return chosen;
}

}  // namespace lacuna
