// SPDX-License-Identifier: Apache-2.0
// The path of a moving scanner, and the directions in which it measures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// A path in one part or several, such as the lines of a flight. A new part begins after ten times the median
// interval of its times.
class Trajectory {
 public:
  // Rows of a file that are not of the path.
  struct LeftOut {
    std::uint64_t rows = 0;
    double time = 0;  // of the first
  };
  // `times` ascend, with a place each; at least two.
  Trajectory(std::vector<double> times, std::vector<Eigen::Vector3d> places, LeftOut left_out = {0, 0});

  const LeftOut& left_out() const { return left_out_; }

  double first_time() const { return times_.front(); }
  double last_time() const { return times_.back(); }
  double length() const { return lengths_.back(); }  // with the ways between parts
  // Returns how far along the path the scanner was; nothing if the path has no part at this time.
  std::optional<double> length_at(double time) const;
  Eigen::Vector3d place_at(double length) const;
  // Returns the axes at a place of the path: forward, to the left and upwards; they are rows of a rotation.
  // Forward is the direction between the places of its part that are `reach` before it and after it.
  Eigen::Matrix3d axes_at(double length, double reach) const;

 private:
  std::vector<double> times_, lengths_;  // lengths: from the first place
  std::vector<Eigen::Vector3d> places_;
  double longest_interval_ = 0;              // within a part
  std::vector<std::size_t> first_of_parts_;  // and the number of places
  LeftOut left_out_;
};

// Reads a file whose columns have names: a time (find_time in io/read/rows/column_rules.hpp), x, y and z, and
// any others. Headers, comments and names are as in scans of text; tx, ty and tz are names of the position,
// too. Rows are in any order. Rows off the path are left out, such as 0 0 0 where a receiver had no position.
// A way there takes a hundred times the median speed, and ten times the speeds below. At most a fifth of the
// rows is left out, or none. Returns nothing if the file names no time: then it lists stations. Throws
// `Error`, also for binary files, and for more lines than `memory` has space for.
std::optional<Trajectory> read_trajectory(const std::filesystem::path& file, std::uint64_t memory);

// The directions from a moving scanner in which it measures, in the axes of its path. A scanner with a
// turning mirror has a thin band of them.
class SweptDirections {
 public:
  SweptDirections();
  void add(const Eigen::Vector3d& direction);  // not 0
  // Keeps the cells of 1.8 degrees with more than a fiftieth of the directions of the fullest one.
  void finish();
  bool contains(const Eigen::Vector3d& direction) const;  // once finished

 private:
  std::vector<std::uint32_t> counts_;
  std::vector<bool> is_swept_;
};

}  // namespace lacuna::io
