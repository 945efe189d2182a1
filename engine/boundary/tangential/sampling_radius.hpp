// SPDX-License-Identifier: Apache-2.0
// sampling_radius: how large the gaps of the sampling itself are around a point (method.md, C.6).
//
// The circumradii of a star's triangles show how large the empty circles between points are. Triangles in a
// hole do not count. Nine in ten of the circumradii around a point, within a bound, do not exceed its
// sampling radius. Unlike the median radius, it is large where points come in pairs, lines or clusters.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/config/config.hpp"
#include "engine/model/ids.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace lacuna::tangential {

// The smallest circumradii of a star that do not lie in a hole (`hole_radius`), in units of
// `Sampling::distance`. Where a star has fewer, the last ones are infinite.
struct StarRadii {
  static constexpr std::size_t kMost = 8;
  std::array<float, kMost> radii;
};

// `link`: a range of link vertices, in any order.
template <class Link>
StarRadii smallest_radii(const Link& link, const TangentialConfig& config);

// These radii with their unit, `Sampling::distance`.
struct ScaledRadii {
  StarRadii star;
  double distance;
};

// The circumradii around a point. It keeps its memory for the next point.
class RadiiAround {
 public:
  // Gathers the circumradii of the stars of a point and its neighbours. radii_of(q): `ScaledRadii`.
  template <class RadiiOf>
  void gather(LocalIndex point, std::span<const LocalIndex> neighbours, RadiiOf&& radii_of) {
    radii_.clear();
    add(radii_of(point));
    for (const LocalIndex q : neighbours) add(radii_of(q));
  }
  // Returns a radius that nine in ten of the circumradii within a bound do not exceed. It is rounded up to a
  // 64th of the bound. Without any circumradius it is the bound. Cost: linear.
  double sampling_radius(double bound) const;

 private:
  static constexpr std::size_t kSteps = 64;

  void add(const ScaledRadii& radii);

  std::vector<double> radii_;
};

// Returns the mean surface share of a point's neighbours, [0, 1]. surface_of(q): `Evaluation::surface_share`.
template <class SurfaceOf>
float surface_around(std::span<const LocalIndex> neighbours, SurfaceOf&& surface_of) {
  float sum = 0;
  for (const LocalIndex q : neighbours) sum += surface_of(q);
  return sum / static_cast<float>(neighbours.size());
}

template <class Link>
StarRadii smallest_radii(const Link& link, const TangentialConfig& config) {
  StarRadii smallest;
  smallest.radii.fill(std::numeric_limits<float>::infinity());
  std::size_t count = 0;
  for (std::size_t i = 0; i < link.size(); ++i) {
    const float radius = link[i].radius;
    if (!(radius <= config.hole_radius)) continue;
    if (count < StarRadii::kMost) {
      smallest.radii[count++] = radius;
    } else if (const auto largest = std::max_element(smallest.radii.begin(), smallest.radii.end());
               radius < *largest) {
      *largest = radius;
    }
  }
  return smallest;
}

}  // namespace lacuna::tangential
