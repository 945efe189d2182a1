// Occupied cells of a lattice, and the point that represents each.
//
// The point nearest to the middle of a cell represents it. Of several, it is the one with the lowest
// coordinates, by x first, and of copies the one with the lowest id. So parts of a scan may be thinned apart,
// and their representatives again: neither order nor parts matter.
#pragma once

#include "engine/store/point_column.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/thin/lattice.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

struct Representative {
  StoredPoint point;
  StoredNormal normal;  // only where the scan has normals
};

// A hash table.
class OccupiedCells {
 public:
  explicit OccupiedCells(std::size_t expected_cells);

  // The point represents its cell if it comes before the one that does so far.
  void add(const LatticePlace& place, const Representative& point);
  // Returns the point of this place's cell, which has one.
  const Representative& at(const LatticePlace& place) const;
  // In the order in which the cells came.
  std::span<const Representative> representatives() const { return representatives_; }
  void clear();

 private:
  struct Cell {
    Eigen::Vector3d cell;
    double squared_offset;  // of the representative
  };
  std::size_t slot_of(const LatticePlace& place) const;
  void build_slots(std::size_t slots);

  std::vector<Cell> cells_;
  std::vector<Representative> representatives_;
  std::vector<std::uint32_t> slots_;  // one more than a cell's index; 0: none. A power of two
};

}  // namespace lacuna
