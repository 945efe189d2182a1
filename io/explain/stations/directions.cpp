// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/directions.hpp"

#include "engine/store/store_file.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <sys/mman.h>

namespace lacuna::io {

std::size_t cell_of(const Eigen::Vector3d& direction, std::size_t edge) {
  const double x = std::fabs(direction.x()), y = std::fabs(direction.y()), z = std::fabs(direction.z());
  const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  const double half = static_cast<double>(edge) / 2;
  const double along = std::fabs(direction[axis]);
  const auto place = [&](int other) {
    return std::min(edge - 1, static_cast<std::size_t>((direction[other] / along + 1) * half));
  };
  const std::size_t face = static_cast<std::size_t>(2 * axis) + (direction[axis] < 0 ? 1 : 0);
  return (face * edge + place((axis + 1) % 3)) * edge + place((axis + 2) % 3);
}

Eigen::Vector3d direction_of(std::size_t cell, std::size_t edge) {
  const std::size_t face = cell / (edge * edge);
  const auto place = [&](std::size_t index) {
    return (2 * static_cast<double>(index) + 1) / static_cast<double>(edge) - 1;
  };
  const int axis = static_cast<int>(face / 2);
  Eigen::Vector3d direction;
  direction[axis] = face % 2 == 0 ? 1 : -1;
  direction[(axis + 1) % 3] = place(cell / edge % edge);
  direction[(axis + 2) % 3] = place(cell % edge);
  return direction.normalized();
}

double RaySpread::angle() const {
  const double mean = sum_.norm() / static_cast<double>(std::max<std::uint64_t>(count_, 1));
  return std::sqrt(std::max(0.0, 2 * (1 - mean)));
}

bool RaySpread::is_narrow() const {
  constexpr double kNarrow = 0.07;
  constexpr std::uint64_t kFewRays = 100;
  return count_ >= kFewRays && angle() < kNarrow;
}

FieldOfView::FieldOfView(const Eigen::Vector3d& axis)
    : axis_(axis), right_(axis.unitOrthogonal()), forward_(axis.cross(right_)) {}

// Uses the sums of components. An arc tangent differs between machines.
std::size_t FieldOfView::bin_of(const Eigen::Vector3d& direction) const {
  const double x = direction.dot(right_), y = direction.dot(forward_);
  const double sum = std::fabs(x) + std::fabs(y);
  if (sum == 0) return 0;
  const double quarter = y >= 0 ? 1 - x / sum : 3 + x / sum;  // from 0 to 4
  const double quarters = static_cast<double>(bins_.size()) / 4;
  return std::min(static_cast<std::size_t>(quarter * quarters), bins_.size() - 1);
}

void FieldOfView::add(const Eigen::Vector3d& direction) {
  const double sine = direction.dot(axis_);
  lowest_ = std::min(lowest_, sine);
  highest_ = std::max(highest_, sine);
  bins_[bin_of(direction)] = true;
}

bool FieldOfView::contains(const Eigen::Vector3d& direction) const {
  const double sine = direction.dot(axis_);
  return sine >= lowest_ && sine <= highest_ && bins_[bin_of(direction)];
}

double FieldOfView::turn() const {
  return static_cast<double>(bins_.count()) / static_cast<double>(bins_.size());
}

void RangeImage::Unmap::operator()(float* cells) const {
  ::munmap(cells, kBytes);
}

RangeImage::RangeImage(const std::filesystem::path& folder)
    : cells_(reinterpret_cast<float*>(StoreFile(folder / "range-image").map(kBytes))) {}

double RangeImage::put(const Eigen::Vector3d& direction, double range) {
  float& cell = cells_[cell_of(direction, kEdge)];
  const float before = cell, rounded = static_cast<float>(range);
  if (before == 0 || rounded < before) cell = rounded;
  return before;
}

// Makes two passes over the offsets to the nearest cell (Danielsson, *Euclidean distance mapping*, 1980).
void RangeImage::fill(std::size_t distance) {
  struct Offset {
    std::int16_t row, column;
    int square() const { return row * row + column * column; }
  };
  constexpr Offset kNone{10'000, 10'000};
  constexpr auto kRow = static_cast<std::ptrdiff_t>(kEdge);
  std::vector<Offset> offsets(kEdge * kEdge);
  for (std::size_t face = 0; face < 6; ++face) {
    float* const cells = cells_.get() + face * kEdge * kEdge;
    for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = cells[i] > 0 ? Offset{0, 0} : kNone;
    const auto take = [&](std::ptrdiff_t at, std::ptrdiff_t row, std::ptrdiff_t column) {
      const Offset& other = offsets[static_cast<std::size_t>(at + row * kRow + column)];
      const Offset through{static_cast<std::int16_t>(other.row + row),
                           static_cast<std::int16_t>(other.column + column)};
      Offset& own = offsets[static_cast<std::size_t>(at)];
      if (through.square() < own.square()) own = through;
    };
    for (const int step : {1, -1}) {
      for (std::ptrdiff_t r = 0; r < kRow; ++r) {
        const std::ptrdiff_t row = step > 0 ? r : kRow - 1 - r;
        if (r > 0)
          for (std::ptrdiff_t column = 0; column < kRow; ++column) take(row * kRow + column, -step, 0);
        for (std::ptrdiff_t column = 1; column < kRow; ++column) take(row * kRow + column, 0, -1);
        for (std::ptrdiff_t column = kRow - 1; column-- > 0;) take(row * kRow + column, 0, 1);
      }
    }
    const int most = static_cast<int>(distance * distance);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      const Offset& offset = offsets[i];
      if (cells[i] == 0 && offset.square() <= most)
        cells[i] = cells[static_cast<std::ptrdiff_t>(i) + offset.row * kRow + offset.column];
    }
  }
}

std::array<std::size_t, kCoarserImages> count_filled(const RangeImage& image) {
  std::vector<bool> has_range(RangeImage::kCells);
  for (std::size_t i = 0; i < has_range.size(); ++i) has_range[i] = image.cells()[i] > 0;
  std::array<std::size_t, kCoarserImages> counts{};
  for (std::size_t level = 0, edge = RangeImage::kEdge; level < counts.size(); ++level, edge /= 2) {
    counts[level] = static_cast<std::size_t>(std::count(has_range.begin(), has_range.end(), true));
    std::vector<bool> coarser(has_range.size() / 4);
    for (std::size_t i = 0; i < has_range.size(); ++i)
      if (has_range[i]) coarser[i / edge / 2 * (edge / 2) + i % edge / 2] = true;
    has_range.swap(coarser);
  }
  return counts;
}

void RangeImage::leave_memory() const {
  ::madvise(cells_.get(), kBytes, MADV_DONTNEED);
}

}  // namespace lacuna::io
