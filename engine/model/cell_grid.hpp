// SPDX-License-Identifier: Apache-2.0
// Where a survey counts points: cubes of one size.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Geometry>

namespace lacuna {

using CellCoord = std::array<std::int32_t, 3>;

// a == b, which calls memcmp: too slow for every point.
inline bool same_cell(const CellCoord& a, const CellCoord& b) {
  return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0;
}

// Cells are cubes of edge 2^(finest + shift): `shift` doublings of the size that a survey began with. They
// are counted from an origin near the points, so a scan may lie anywhere on Earth with millimetre spacing.
// The origin is a whole number of finest cells along each axis. Cells are found by rounding down before it is
// subtracted. Both steps are exact. Points more than `kLast` finest cells away belong to the last cell on
// that side, which therefore has no end. A point keeps its cell's ancestor however often cells are merged.
struct CellGrid {
  static constexpr std::int32_t kLast = 1 << 30;
  static constexpr int kMaxShift = 30;
  // The bits of this coordinate alternate. So its distance to the nearest border of a node of OpenVDB's tree
  // is a third of the node's size, however often cells merge. A scan in the middle of few nodes needs few of
  // them.
  static constexpr std::int32_t kMiddle = 0x2aaaaaa;

  int finest = 0;  // within +-900, so that its powers of two are normal numbers
  int shift = 0;
  std::array<double, 3> origin{};  // in finest cells

  // Finest cells, from 2^finest, so that `middle` lies in the one with `kMiddle` along each axis.
  static CellGrid around(const Eigen::Vector3d& middle, int finest);

  double edge() const;
  CellCoord cell_of(const Eigen::Vector3d& position) const;
  // Finds the cells of many points, several at a time; some cell where a coordinate is not a number.
  void cells_of(std::span<const Eigen::Vector3d> positions, std::span<CellCoord> cells) const;
  // Whether the cell is the last along an axis.
  bool is_unbounded(const CellCoord& cell) const;
  // Smallest box that holds all points of the cells from `low` to `high`.
  Eigen::AlignedBox3d box(const CellCoord& low, const CellCoord& high) const;
};

struct CountedCell {
  CellCoord coord{};
  std::uint32_t points = 0;
};

}  // namespace lacuna
