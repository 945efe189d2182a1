// SPDX-License-Identifier: Apache-2.0
// z_curve: an order of points that keeps neighbours together at any density.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

// A place in the lattice of the curve: 2^62 steps along the longest side of a box.
using ZPlace = std::array<std::uint64_t, 3>;

// The Z curve (Morton 1966) through a box. The order of two places follows from the highest bit in which any
// of their coordinates differ. So no interleaved key is needed (Chan, "Closest-point problems simplified on
// the RAM", SODA 2002).
class ZCurve {
 public:
  // An empty box: every point has the same place.
  explicit ZCurve(const Eigen::AlignedBox3d& box);

  // Returns equal places for equal points. Points outside of the box are moved to its sides.
  ZPlace place(const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  double scale_ = 0;
};

// Returns whether `a` comes before `b` on the curve.
bool comes_before(const ZPlace& a, const ZPlace& b);

// Cuts places in ascending order into runs of at most `most`, where the curve leaves one half of a box for
// the other. So the boxes of the runs are small. Returns the end of each run. Cost: linear, times the depth
// of the cuts.
std::vector<std::uint32_t> cut_runs(std::span<const ZPlace> places, std::size_t most);

}  // namespace lacuna
