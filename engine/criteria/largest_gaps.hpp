// The largest gaps between the directions of eight points' neighbours in their tangent planes (paper, 4.2).
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/eight.hpp"
#include "engine/criteria/bundle.hpp"

#include <cstddef>

namespace lacuna {

// Directions nearer than this, in radians, are one direction (its nearest neighbour stands for it), gaps
// nearer than this are equally large: exact symmetries of the points must not be decided by rounding.
inline constexpr double kSameDirection = 1e-9;

// A neighbour whose projection is shorter than this share of its distance projects onto p.
inline constexpr double kNoDirection = 1e-12;

struct TangentPlanes {
  Eight normals[3];  // unit; NaN: none, and no gap
  double cos_cone;   // neighbours with |<n, q - p>| > cos_cone |q - p| have no stable direction
};

// As in `Gap`.
struct BundledGaps {
  Eight size, used, near, far;
};

// Directions are sorted in single precision. Where the largest gap is larger than any other by more than that
// can be wrong, its size is taken in double; elsewhere the point is done with care, below. Which way is taken
// depends on the point alone.
using FindLargestGaps = void(const Bundle&, const TangentPlanes&, BundledGaps&);
LACUNA_DECLARE(FindLargestGaps, find_largest_gaps)

// ---- One of the points, in double precision throughout (careful.cpp)

struct GapFit {
  double size = 0;
  double used = 0;
  double near = -1, far = -1;
};

GapFit largest_gap_carefully(const Bundle& bundle, std::size_t point, const double normal[3],
                             double cos_cone);

}  // namespace lacuna
