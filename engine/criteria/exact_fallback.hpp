// SPDX-License-Identifier: Apache-2.0
// One point of a batch, in double precision throughout: where the kernels find that rounding may decide. Each
// way is another algorithm than the kernel's, since the kernel's own loses digits there in any precision.
#pragma once

#include "engine/criteria/neighbour_batch.hpp"

#include <cstddef>

namespace lacuna {

// Directions nearer than this, in radians, are one direction, that of its nearest neighbour. Gaps that differ
// by less are equally large. So rounding does not decide exact symmetries of the points.
inline constexpr double kSameDirection = 1e-9;

// A neighbour whose projection is shorter than this share of its distance projects onto p.
inline constexpr double kNoDirection = 1e-12;

struct LargestGap {
  double size = 0;
  double used = 0;
  double near = -1, far = -1;  // as in `Gap`
};

// The directions are sorted by their angles, with equal ones united. The kernel sorts angles of 24 bits with
// the neighbours' ranks in the lowest ones. That leaves no bits for angles in double precision.
LargestGap find_largest_gap_exactly(const NeighbourBatch& batch, std::size_t point, const double normal[3],
                                    double cos_cone);

struct PlaneFit {
  double eigenvalues[3];  // largest first
  double normal[3];
  bool has_normal;
};

// Fits a plane to a covariance xx, yy, zz, xy, xz, yz. By an iterative eigensolver: the kernel's closed form
// takes the difference of nearly equal numbers where two eigenvalues are nearly equal.
PlaneFit fit_plane_exactly(const double covariance[6]);

}  // namespace lacuna
