// SPDX-License-Identifier: Apache-2.0
// radius_bound: the largest circumradius of a triangle. It follows from how points lie around the star's
// point (method.md, C.2).
//
// The circumradii of a star show how large the empty circles of the sampling are, and how much they differ.
// On a grid all are 0.71 spacings; among points at random there are small and large ones. At a hole some are
// large since the triangles lie in it, so a median over a point's neighbours decides. Triangles that
// certainly lie in a hole are left out, since on strips and islands half of the triangles do.
#pragma once

#include "engine/boundary/tangential/stars.hpp"
#include "engine/config/config.hpp"
#include "engine/simd/batch.hpp"

#include <array>
#include <span>
#include <vector>

namespace lacuna::tangential {

// Returns the samplings of found stars, up to kBatchSize at a time. Returns zeros where a link is empty.
std::array<Sampling, kBatchSize> samplings_of(std::span<const FoundStar> stars,
                                              const TangentialConfig& config);

// A point and its neighbours, by their places among the samplings.
struct PointAndNeighbours {
  LocalIndex point;
  std::span<const LocalIndex> neighbours;
};

// M is the median circumradius of a point and its neighbours, and S is the median of their spreads. Each is
// at most half of the point's mean distance (`most_radius`). The fine bound is 1.5 M + S (`max_radius`), and
// the coarse bound is twice as large (`coarse_bound`). Points without a star, or with large triangles only,
// do not count. Where no point counts, M and S are half of the mean distance. The bounds of a point without a
// star are 0. The class takes a batch of points at once and keeps its memory.
class RadiusBounder {
 public:
  RadiusBounder(std::span<const Sampling> samplings, const TangentialConfig& config)
      : samplings_(samplings), config_(config) {}

  // Calls visit(i, bound) for each of `count` points. surroundings(i) returns the surroundings of point i. A
  // bound does not depend on the other points.
  template <class Around, class Visit>
  void for_each(std::size_t count, Around&& surroundings, Visit&& visit) {
    for_each_batch(count, points_, surroundings, [&](std::size_t first) {
      find();
      for (std::size_t i = 0; i < points_.size(); ++i) visit(first + i, bounds_[i]);
    });
  }

 private:
  void find();  // the bounds of `points_`

  std::span<const Sampling> samplings_;
  TangentialConfig config_;
  std::vector<PointAndNeighbours> points_;
  std::vector<Batch<double>> medians_, spreads_;
  std::array<RadiusBound, kBatchSize> bounds_;
};

}  // namespace lacuna::tangential
