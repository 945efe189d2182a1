// SPDX-License-Identifier: Apache-2.0
// Points that are in a scan more than once, as in tiles that overlap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// Holds a hash of each point, as long as all fit in `memory` bytes. Beyond that it goes on with an even
// sample, and is no longer exact. Two points of one place and one time are the same: a second strip has other
// times.
class RepeatedPoints {
 public:
  // Places differ if they are further apart than `step`: files may round them differently.
  RepeatedPoints(double step, std::uint64_t memory);

  // Whether the point was added before. False for points that are not in the sample.
  bool add(const Eigen::Vector3d& place, double time);
  bool is_exact() const { return sample_ == 0; }
  std::uint64_t count() const { return count_ << sample_; }  // an estimate if it is not exact

 private:
  bool put(std::uint64_t hash);
  void make_space();

  double steps_;  // in a unit of the scan
  std::size_t most_;
  std::vector<std::uint64_t> slots_;  // 0: free
  std::uint64_t used_ = 0, count_ = 0;
  unsigned sample_ = 0;  // one point in two to this power is in the sample
};

}  // namespace lacuna::io
