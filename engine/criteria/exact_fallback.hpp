// SPDX-License-Identifier: Apache-2.0
// The exact fallback takes one point of a batch, in double precision throughout. It decides where rounding
// may decide in the kernels. Its algorithms differ from the kernels', since the kernels' own lose digits
// there in any precision.
#pragma once

#include "engine/criteria/neighbour_batch.hpp"

#include <cstddef>

namespace lacuna {

// Directions nearer than this, in radians, are one direction, the direction of the nearest of their
// neighbours. Gaps that differ by less are equally large. So rounding does not decide exact symmetries of the
// points.
inline constexpr double kSameDirection = 1e-9;

// A neighbour whose projection is shorter than this fraction of its distance projects onto p.
inline constexpr double kNoDirection = 1e-12;

struct LargestGap {
  double size = 0;
  double used = 0;
  double near = -1, far = -1;  // as in `Gap`
};

// The directions are sorted by their angles, and equal ones are united. The kernel sorts angles of 24 bits
// with the neighbours' ranks in the lowest ones. That leaves no bits for angles in double precision.
LargestGap find_largest_gap_exactly(const NeighbourBatch& batch, std::size_t point, const double normal[3],
                                    double cos_cone);

struct PlaneFit {
  double eigenvalues[3];  // largest first
  double normal[3];
  bool has_normal;
};

// Fits a plane to a covariance xx, yy, zz, xy, xz, yz. It uses an iterative eigensolver. The kernel's closed
// form takes the difference of nearly equal numbers where two eigenvalues are nearly equal.
PlaneFit fit_plane_exactly(const double covariance[6]);

}  // namespace lacuna
