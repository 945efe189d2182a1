// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/range_image.hpp"

#include "engine/store/store_file.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <sys/mman.h>

namespace lacuna::io {

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
