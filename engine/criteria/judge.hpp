// The criteria of eight points at once (paper, 4.2 to 4.6): plain arrays in, plain arrays out, so that the
// arithmetic can be compiled for each instruction set.
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/eight.hpp"

#include <cstddef>

namespace lacuna {

inline constexpr std::size_t kBundle = kEight;            // points judged together
inline constexpr std::size_t kMostSortedDirections = 64;  // side by side

// Directions nearer than this, in radians, are one direction (its nearest neighbour stands for it), gaps
// nearer than this are equally large: exact symmetries of the points must not be decided by rounding.
inline constexpr double kSameDirection = 1e-9;

// A neighbour whose projection is shorter than this share of its distance projects onto p.
inline constexpr double kNoDirection = 1e-12;

// Neighbourhoods side by side: row i holds the i-th neighbour of each point. Beyond a point's count its
// offsets are 0.
struct Bundle {
  std::size_t rows = 0;  // the largest count
  Eight counts;          // neighbours of each point, from 1 on
  Eight* x = nullptr;    // offsets q - p, by row
  Eight* y = nullptr;
  Eight* z = nullptr;
  Eight given_normals[3];       // unit; NaN: to be estimated
  std::size_t sorted_rows = 0;  // the first rows, at most kMostSortedDirections
  Eight* distance = nullptr;    // working space, by row
  Eight* weight = nullptr;
  Eight* direction = nullptr;
};

struct JudgeParameters {
  double sigma;             // over r_p
  double cos_cone;          // neighbours with |<n, q - p>| > cos_cone |q - p| have no stable direction
  double crease_threshold;  // angle probability from which a crease is looked for
  double shares[3];         // of the criteria, in the order of the table; sum 1
};

struct Judgements {
  Eight criteria[3];     // in the order of the table
  Eight probability;     // Pi: combined, a multiple of 2^-24
  Eight mean_distance;   // r_p
  Eight mean_offset[3];  // mu_p - p
  Eight normal[3];       // NaN: none
  Eight gap_near;        // ranks of the gap neighbours, nearer first; -1: none
  Eight gap_far;
};

using Judge = void(const Bundle&, const JudgeParameters&, Judgements&);
LACUNA_DISPATCH(Judge, judge)

// ---- What few points need, done for one of them (careful.cpp)

struct PlaneFit {
  double mean_offset[3];
  double eigenvalues[3];  // largest first
  double normal[3];
  bool has_normal;
};

// Where the closed form loses digits: weights of the standard library and an iterative eigensolver.
PlaneFit fit_plane_carefully(const Bundle& bundle, std::size_t point, double sigma);

struct GapFit {
  double size = 0;
  double used = 0;
  double near = -1, far = -1;
};

// Where directions coincide, or are more than kMostSortedDirections.
GapFit largest_gap_carefully(const Bundle& bundle, std::size_t point, const double normal[3],
                             double cos_cone);

}  // namespace lacuna
