// SPDX-License-Identifier: Apache-2.0
// Points that are in a scan more than once, as in tiles that overlap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// How far two copies of a point lie apart at most, along each axis: files may round them differently. Both
// are above 0. Without a time, chance brings points near each other, too.
struct CopyDistance {
  double with_time, without_time;
};

// Holds a hash of each point, as long as all fit in `memory` bytes. Beyond that it goes on with an even
// sample, and is no longer exact. Two points of about one place and one time are the same: a second strip has
// other times.
class RepeatedPoints {
 public:
  RepeatedPoints(CopyDistance apart, std::uint64_t memory);

  // Whether the point was added before; `time` is 0 where it is not stated: then it must have the same place.
  // False for points that are not in the sample. Cost: that of a look-up, or of up to eight for points near
  // the border of a cell.
  bool add(const Eigen::Vector3d& place, double time);
  bool is_exact() const { return sample_ == 0; }
  std::uint64_t count() const { return count_ << sample_; }  // an estimate if it is not exact
  // Likewise the points without a time that are near another one: copies, or there by chance.
  std::uint64_t near() const { return near_ << sample_; }

 private:
  // A cell and a time, as a hash, and the place within the cell, in steps along each axis.
  struct Key {
    std::uint64_t hash;
    std::array<int, 3> steps;
  };
  bool is_in_sample(std::uint64_t hash) const;
  std::size_t slot_of(std::uint64_t hash) const;
  int nearest(const Key& key) const;
  void put(std::uint64_t slot);
  void make_space();

  CopyDistance apart_;
  std::size_t most_;
  std::vector<std::uint64_t> slots_;  // the hash, and below it the steps; 0: free
  std::uint64_t used_ = 0, count_ = 0, near_ = 0;
  unsigned sample_ = 0;  // one cell in two to this power is in the sample
};

}  // namespace lacuna::io
