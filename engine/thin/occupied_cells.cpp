#include "engine/thin/occupied_cells.hpp"

#include <algorithm>

namespace lacuna {
namespace {

// A cell, and its slots: from one and a half to three, and as many again while they are built anew.
constexpr std::uint64_t kBytesPerCell = sizeof(OccupiedCell) + 6 * sizeof(std::uint32_t);
constexpr std::size_t kFewestSlots = 1024;

bool is_full(std::size_t cells, std::size_t slots) {
  return 3 * cells > 2 * slots;
}

// Where points are equally near, the lowest coordinates decide, so that the order of the input does not
// matter.
bool comes_first(const Eigen::Vector3d& position, PointId id, const OccupiedCell& cell) {
  for (int axis = 0; axis < 3; ++axis) {
    if (position[axis] != cell.nearest[axis]) return position[axis] < cell.nearest[axis];
  }
  return id < cell.id;
}

}  // namespace

OccupiedCells::OccupiedCells(CellShare share, std::uint64_t memory)
    : share_(share), most_(std::max<std::size_t>(memory / kBytesPerCell, 1)), slots_(kFewestSlots) {}

// The slot with this cell, or the empty one where it belongs.
std::uint32_t& OccupiedCells::slot_of(const LatticePlace& place) {
  std::size_t slot = first_slot(place.hash);
  while (slots_[slot] != 0 && cells_[slots_[slot] - 1].cell != place.cell)
    slot = slot + 1 < slots_.size() ? slot + 1 : 0;
  return slots_[slot];
}

OccupiedCell* OccupiedCells::find(const LatticePlace& place) {
  const std::uint32_t slot = slot_of(place);
  return slot == 0 ? nullptr : &cells_[slot - 1];
}

bool OccupiedCells::add(const LatticePlace& place) {
  std::uint32_t* slot = &slot_of(place);
  if (*slot == 0) {
    if (cells_.size() == most_) return false;
    if (is_full(cells_.size() + 1, slots_.size())) {
      build_slots(2 * slots_.size());
      slot = &slot_of(place);
    }
    cells_.push_back({.cell = place.cell, .sums = {}});
    *slot = static_cast<std::uint32_t>(cells_.size());
  }
  OccupiedCell& cell = cells_[*slot - 1];
  for (std::size_t axis = 0; axis < 3; ++axis) cell.sums[axis] += place.offset[axis];
  ++cell.points;
  return true;
}

void OccupiedCells::halve() {
  share_ = share_.half(false);
  std::erase_if(cells_, [&](const OccupiedCell& cell) { return !share_.contains(hash_of(cell.cell)); });
  build_slots(slots_.size());
}

void OccupiedCells::build_slots(std::size_t slots) {
  slots_.assign(slots, 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    std::size_t slot = first_slot(hash_of(cells_[i].cell));
    while (slots_[slot] != 0) slot = slot + 1 < slots ? slot + 1 : 0;
    slots_[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

void OccupiedCells::prefetch(const LatticePlace& place) const {
  __builtin_prefetch(&slots_[first_slot(place.hash)]);
}

void offer(OccupiedCell& cell, const LatticePlace& place, const Eigen::Vector3d& position,
           const Eigen::Vector3d& normal, PointId id) {
  double distance = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double mean = static_cast<double>(cell.sums[axis]) / static_cast<double>(cell.points);
    const double difference = static_cast<double>(place.offset[axis]) - mean;
    distance += difference * difference;
  }
  if (distance > cell.distance) return;
  if (distance == cell.distance && !comes_first(position, id, cell)) return;
  cell.distance = distance;
  cell.nearest = position;
  cell.normal = normal;
  cell.id = id;
}

}  // namespace lacuna
