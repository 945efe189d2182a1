// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cell_grid.hpp"

#include "engine/simd/vectorised.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace lacuna {

namespace {

// To multiply by a power of two is exact, so every pass finds the same cell. Exponents of grids give normal
// numbers.
double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

// Rounds down the coordinates of points one after the other. It takes rows of four points, which fill whole
// registers.
LACUNA_VECTORISED
void round_down(const double* coordinates, std::size_t count, double scale, const double* origin, int shift,
                std::int32_t* cells) {
  constexpr double kLast = CellGrid::kLast;
  constexpr std::size_t kRow = 12;
  double origins[kRow];
  for (std::size_t i = 0; i < kRow; ++i) origins[i] = origin[i % 3];
  const auto cell = [=](double coordinate, double first) {
    const double index = std::floor(coordinate * scale) - first;
    return static_cast<std::int32_t>(std::max(-kLast, std::min(kLast, index))) >> shift;  // NaN: kLast
  };
  std::size_t i = 0;
  for (; i + kRow <= count; i += kRow) {
    for (std::size_t j = 0; j < kRow; ++j) cells[i + j] = cell(coordinates[i + j], origins[j]);
  }
  for (std::size_t j = 0; i + j < count; ++j) cells[i + j] = cell(coordinates[i + j], origins[j]);
}

}  // namespace

CellGrid CellGrid::around(const Eigen::Vector3d& middle, int finest) {
  const auto along = [&](double x) { return std::floor(std::ldexp(x, -finest)) - kMiddle; };
  return {.finest = finest, .origin = {along(middle.x()), along(middle.y()), along(middle.z())}};
}

double CellGrid::edge() const {
  return power_of_two(finest + shift);
}

CellCoord CellGrid::cell_of(const Eigen::Vector3d& position) const {
  CellCoord cell;
  cells_of({&position, 1}, {&cell, 1});
  return cell;
}

void CellGrid::cells_of(std::span<const Eigen::Vector3d> positions, std::span<CellCoord> cells) const {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(CellCoord) == 12);
  assert(positions.size() == cells.size());
  if (positions.empty()) return;
  round_down(positions.front().data(), 3 * positions.size(), power_of_two(-finest), origin.data(), shift,
             cells.front().data());
}

bool CellGrid::is_unbounded(const CellCoord& cell) const {
  const std::int32_t last = kLast >> shift;
  return std::any_of(cell.begin(), cell.end(), [&](std::int32_t c) { return c == -last || c == last; });
}

Eigen::AlignedBox3d CellGrid::box(const CellCoord& low, const CellCoord& high) const {
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  const std::int32_t last = kLast >> shift;
  const double unit = power_of_two(finest), size = power_of_two(shift);
  Eigen::AlignedBox3d box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    box.min()[at] = low[axis] == -last ? -kEverywhere : (low[axis] * size + origin[axis]) * unit;
    box.max()[at] = high[axis] == last ? kEverywhere : ((high[axis] + 1.0) * size + origin[axis]) * unit;
  }
  return box;
}

}  // namespace lacuna
