// Occupied cells of a lattice, and the point that represents each: the one nearest to the mean of its cell.
//
// The points are streamed twice. The first pass adds up where they lie in their cells, in whole numbers, so
// that their order does not matter. The second pass finds the nearest one. Where there are several, it is the
// one with the lowest coordinates, by x first, and of copies the one with the lowest id.
#pragma once

#include "engine/model/ids.hpp"
#include "engine/thin/lattice.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// The cells whose hash ends in the `bits` bits of `ending`: as many of all cells as fit in memory.
struct CellShare {
  int bits = 0;
  std::uint64_t ending = 0;

  bool contains(std::uint64_t hash) const { return (hash & ((std::uint64_t{1} << bits) - 1)) == ending; }
  // The two halves of it.
  CellShare half(bool upper) const { return {bits + 1, ending | (std::uint64_t{upper} << bits)}; }
};

struct OccupiedCell {
  Eigen::Vector3d cell;               // of the lattice
  std::array<std::uint64_t, 3> sums;  // of the points' offsets
  std::uint64_t points = 0;
  // The point nearest to the mean, of those offered so far.
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  double distance = std::numeric_limits<double>::infinity();  // squared
  PointId id{};
};

// A hash table in bounded memory.
class OccupiedCells {
 public:
  explicit OccupiedCells(CellShare share, std::uint64_t memory);

  const CellShare& share() const { return share_; }
  std::size_t size() const { return cells_.size(); }
  const std::deque<OccupiedCell>& all() const { return cells_; }

  // The cell of this place; null where no point was added to it.
  OccupiedCell* find(const LatticePlace& place);
  // First pass. False where that needs more memory than there is: nothing was added.
  bool add(const LatticePlace& place);
  // Leaves the cells out that are not of the share's lower half, which is the share from now on.
  void halve();
  // Brings the cell of this place into the processor's cache.
  void prefetch(const LatticePlace& place) const;

 private:
  std::size_t first_slot(std::uint64_t hash) const { return (hash >> 32) & (slots_.size() - 1); }
  std::uint32_t& slot_of(const LatticePlace& place);
  void build_slots(std::size_t slots);

  CellShare share_;
  std::size_t most_;  // cells
  std::deque<OccupiedCell> cells_;
  std::vector<std::uint32_t> slots_;  // one more than a cell's index; 0: none
};

// Second pass: the point becomes the cell's nearest one if it is.
void offer(OccupiedCell& cell, const LatticePlace& place, const Eigen::Vector3d& position,
           const Eigen::Vector3d& normal, PointId id);

}  // namespace lacuna
