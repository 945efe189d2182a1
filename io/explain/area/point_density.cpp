// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/point_density.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna::io {
namespace {

void sort_unique(std::vector<std::size_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

double spacing_of(std::uint64_t points, std::uint64_t cells) {
  return points > 0 ? std::sqrt(static_cast<double>(cells) / static_cast<double>(points))
                    : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::uint64_t PointDensity::area_of(std::size_t square, const PlanRaster& inside) const {
  const std::size_t from = square % columns_ * kEdge, to = std::min(from + kEdge, inside.columns());
  const std::size_t first = square / columns_ * kEdge;
  std::uint64_t cells = 0;
  for (std::size_t row = first; row < std::min(first + kEdge, inside.rows()); ++row)
    cells += count_bits(inside.row(row), from, to);
  return cells;
}

double PointDensity::spacing(const PlanRaster& inside) const {
  std::uint64_t points = 0, cells = 0;
  for (std::size_t square = 0; square < points_.size(); ++square) {
    if (points_[square] == 0) continue;
    points += points_[square];
    cells += area_of(square, inside);
  }
  return spacing_of(points, cells);
}

double PointDensity::spacing_around(const PlanPolygon& outline, const PlanRaster& inside) const {
  constexpr std::size_t kReach = 2;
  const std::size_t rows = points_.size() / columns_;
  std::vector<std::size_t> passed, around;  // squares
  for (const Ring2& ring : outline) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double steps = std::max(std::ceil((b - a).norm() / static_cast<double>(kEdge)), 1.0);
      for (double step = 0; step < steps; ++step) {
        const Eigen::Vector2d at = a + (b - a) * step / steps;
        passed.push_back(static_cast<std::size_t>(at.y()) / kEdge * columns_ +
                         static_cast<std::size_t>(at.x()) / kEdge);
      }
    }
  }
  sort_unique(passed);
  for (const std::size_t square : passed) {
    const std::size_t column = square % columns_, row = square / columns_;
    for (std::size_t r = row - std::min(row, kReach); r <= std::min(row + kReach, rows - 1); ++r)
      for (std::size_t c = column - std::min(column, kReach); c <= std::min(column + kReach, columns_ - 1);
           ++c)
        if (points_[r * columns_ + c] > 0) around.push_back(r * columns_ + c);
  }
  sort_unique(around);
  std::uint64_t points = 0, cells = 0;
  for (const std::size_t square : around) {
    if (std::binary_search(passed.begin(), passed.end(), square)) continue;
    points += points_[square];
    cells += area_of(square, inside);
  }
  return spacing_of(points, cells);
}

}  // namespace lacuna::io
