// SPDX-License-Identifier: Apache-2.0
// Which points of a scan count when an area is checked.
//
// Idea: no-data values and clouds leave a gap of heights to the ground, and cover nothing. Points that are in
// a scan more than once, as in tiles that overlap, count once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// A run of heights. The next ones above and below are further away than a gap.
struct HeightGroup {
  double low, high;
  std::uint64_t points;
};

// Divides heights at gaps without any height. A group is of the ground if it has a twentieth of the points or
// more, and more than one value. If none is so, it is the largest group. All other groups lie apart: rasters
// state one value for "no data", and returns of clouds, birds or mirrors are few. So steep ground, trees,
// towers and bridges belong to the ground, as long as their heights leave no such gap.
//
// The groups do not depend on the order of the heights. Memory: 24 bytes for each group, and 16,384 of them;
// heights beyond that lie apart.
class HeightGroups {
 public:
  explicit HeightGroups(double gap) : gap_(gap) {}

  void add(double height);

  // Both ascend. The groups of the ground are empty without a height.
  struct Parts {
    std::vector<HeightGroup> ground, apart;
  };
  Parts parts() const;

 private:
  double gap_;
  std::vector<HeightGroup> groups_;  // ascending
  std::size_t last_ = 0;             // the group of the last height
  std::uint64_t others_ = 0;         // heights beyond
};

// Whether a height is of one of the groups, or nearer to it than the gap.
bool is_of(const std::vector<HeightGroup>& groups, double height, double gap);

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
