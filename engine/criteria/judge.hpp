// The criteria of eight points at once (paper, 4.2 to 4.6).
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/eight.hpp"
#include "engine/criteria/bundle.hpp"

#include <cstddef>

namespace lacuna {

struct JudgeParameters {
  double sigma;             // over r_p
  double cos_cone;          // as in `TangentPlanes`
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

// ---- One of the points (careful.cpp)

struct PlaneFit {
  double mean_offset[3];
  double eigenvalues[3];  // largest first
  double normal[3];
  bool has_normal;
};

// Where the closed form loses digits: weights of the standard library and an iterative eigensolver.
PlaneFit fit_plane_carefully(const Bundle& bundle, std::size_t point, double sigma);

}  // namespace lacuna
