#include "engine/thin/occupied_cells.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

namespace lacuna {
namespace {

auto order_of(const StoredPoint& p) {
  return std::tie(p.x, p.y, p.z, p.id);
}

}  // namespace

OccupiedCells::OccupiedCells(std::size_t expected_cells) {
  cells_.reserve(expected_cells);
  representatives_.reserve(expected_cells);
  build_slots(std::bit_ceil(2 * expected_cells + 1));
}

// The slot with this cell, or the empty one where it belongs.
std::size_t OccupiedCells::slot_of(const LatticePlace& place) const {
  std::size_t slot = (place.hash >> 32) & (slots_.size() - 1);
  while (slots_[slot] != 0 && cells_[slots_[slot] - 1].cell != place.cell)
    slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void OccupiedCells::add(const LatticePlace& place, const Representative& point) {
  std::size_t slot = slot_of(place);
  if (slots_[slot] == 0) {
    if (2 * (cells_.size() + 1) > slots_.size()) {
      build_slots(2 * slots_.size());
      slot = slot_of(place);
    }
    cells_.push_back({place.cell, place.squared_offset});
    representatives_.push_back(point);
    slots_[slot] = static_cast<std::uint32_t>(cells_.size());
    return;
  }
  Cell& cell = cells_[slots_[slot] - 1];
  Representative& before = representatives_[slots_[slot] - 1];
  if (place.squared_offset > cell.squared_offset) return;
  if (place.squared_offset == cell.squared_offset && order_of(before.point) < order_of(point.point)) return;
  cell.squared_offset = place.squared_offset;
  before = point;
}

const Representative& OccupiedCells::at(const LatticePlace& place) const {
  return representatives_[slots_[slot_of(place)] - 1];
}

void OccupiedCells::clear() {
  cells_.clear();
  representatives_.clear();
  std::fill(slots_.begin(), slots_.end(), 0);
}

void OccupiedCells::build_slots(std::size_t slots) {
  slots_.assign(slots, 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const LatticePlace place{.cell = cells_[i].cell, .squared_offset = 0, .hash = hash_of(cells_[i].cell)};
    slots_[slot_of(place)] = static_cast<std::uint32_t>(i + 1);
  }
}

}  // namespace lacuna
