// SPDX-License-Identifier: Apache-2.0
// The nearest range that a station measured in each direction.
#pragma once

#include "io/explain/stations/direction_cells.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include <Eigen/Core>

namespace lacuna::io {

// Its cells (io/explain/stations/direction_cells.hpp) are 0.11 degrees wide in the middle of a face. They lie in a
// file that has no name any more: 25 MiB, of which only touched pages take memory.
class RangeImage {
 public:
  static constexpr std::size_t kEdge = 1024;  // cells along an edge of a face
  static constexpr std::size_t kCells = 6 * kEdge * kEdge;
  static constexpr std::size_t kBytes = kCells * sizeof(float);

  RangeImage() = default;  // has no cells
  // `folder` holds the file; if it is empty, the image is in memory. Throws `Error`.
  explicit RangeImage(const std::filesystem::path& folder);

  // Keeps the smaller range, and returns the range before; 0 if there was none. The direction need not have
  // length 1, but must not be 0.
  double put(const Eigen::Vector3d& direction, double range);
  // An empty cell at most so many cells from one with a range gets the range of the nearest, within its face.
  // Among equally near cells, the first in the order of cells counts.
  void fill(std::size_t distance);

  // Returns the range in this direction; 0 if nothing came back.
  float at(const Eigen::Vector3d& direction) const { return cells()[cell_of(direction, kEdge)]; }
  std::span<const float> cells() const { return {cells_.get(), kCells}; }
  // Its pages leave memory, and come back when they are used.
  void leave_memory() const;

 private:
  struct Unmap {
    void operator()(float* cells) const;
  };
  std::unique_ptr<float[], Unmap> cells_;
};

// Returns how many cells have a range: of the image, and of ever coarser ones, each with half the edge.
inline constexpr std::size_t kCoarserImages = 7;
std::array<std::size_t, kCoarserImages> count_filled(const RangeImage& image);

}  // namespace lacuna::io
