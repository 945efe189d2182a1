// SPDX-License-Identifier: Apache-2.0
// What a scanner saw: the directions in which it had returns, and the nearest range in each.
//
// Idea: directions have cells. Each of the six faces of a cube has `edge` times `edge` square ones.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include <Eigen/Core>

namespace lacuna::io {

// Faces are at right angles to the axes. So directions need no arithmetic but divisions, and have the same
// cell on every machine. The direction need not have length 1, but must not be 0.
std::size_t cell_of(const Eigen::Vector3d& direction, std::size_t edge);
Eigen::Vector3d direction_of(std::size_t cell, std::size_t edge);  // its middle, of length 1

// Radians that a cell is wide in the middle of a face; half of that at its sides.
inline double cell_angle(std::size_t edge) {
  return 2 / static_cast<double>(edge);
}

// Ranges in one direction that differ by more than this share are of two surfaces, and a ray ends at the
// first.
inline constexpr double kConflict = 0.1;

// How far the rays of a scanner spread around their mean direction. From a place far off, all points lie in
// one direction, and ranges say nothing of what is before what.
class RaySpread {
 public:
  void add(const Eigen::Vector3d& direction) {  // of length 1
    sum_ += direction;
    ++count_;
  }
  // Returns the root mean square of the angles to the mean direction, in radians; 0 without rays. It is
  // small, or an estimate.
  double angle() const;
  // Whether no scanner has so narrow a view: 4 degrees, as a square window of 10 degrees. A few rays do not
  // count.
  bool is_narrow() const;

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  std::uint64_t count_ = 0;
};

class FieldOfView {
 public:
  explicit FieldOfView(const Eigen::Vector3d& axis);
  void add(const Eigen::Vector3d& direction);
  bool contains(const Eigen::Vector3d& direction) const;  // both of length 1

  double lowest() const { return lowest_; }  // sines of the elevation; lowest > highest: nothing was added
  double highest() const { return highest_; }
  double turn() const;  // share of a whole turn around the axis

 private:
  std::size_t bin_of(const Eigen::Vector3d& direction) const;

  Eigen::Vector3d axis_, right_, forward_;
  double lowest_ = 1, highest_ = -1;
  std::bitset<512> bins_;  // around the axis, with returns
};

// Its cells are 0.11 degrees wide in the middle of a face. They lie
// in a file that has no name any more: 25 MiB, of which only touched pages take memory.
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
