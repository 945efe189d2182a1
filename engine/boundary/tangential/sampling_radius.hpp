// sampling_radius: how large the gaps of the sampling itself are around a point (method.md, C.6).
//
// The empty circles of a star that lie among points show the sampling; those in a hole do not. Nine in ten of
// the circles around a point, within a bound, are no larger than its sampling radius. Unlike the median of
// the circles, it is large where points come in pairs, rows or clusters.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/config.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace lacuna::tangential {

// Of a star, the smallest circumradii that do not lie in a hole (`hole_radius`), in units of
// `Sampling::distance`; infinity where there are fewer.
struct StarCircles {
  static constexpr std::size_t kMost = 8;
  std::array<float, kMost> radii;
};

// `link`: a range of link vertices, in any order.
template <class Link>
StarCircles circles_of(const Link& link, const TangentialConfig& config);

// The circles around a point: keeps its memory.
class SamplingRadius {
 public:
  void clear() { circles_.clear(); }
  // The circles of the point's star, or of a neighbour's.
  void add(const StarCircles& circles, double distance);
  // What nine in ten of the circles within a bound do not exceed, rounded up to a 64th of the bound; the
  // bound itself where there are none. Cost: linear.
  double within(double bound);

 private:
  static constexpr std::size_t kSteps = 64;

  std::vector<double> circles_;
};

template <class Link>
StarCircles circles_of(const Link& link, const TangentialConfig& config) {
  StarCircles circles;
  circles.radii.fill(std::numeric_limits<float>::infinity());
  std::size_t count = 0;
  for (std::size_t i = 0; i < link.size(); ++i) {
    const float radius = link[i].radius;
    if (!(radius <= config.hole_radius)) continue;
    if (count < StarCircles::kMost) {
      circles.radii[count++] = radius;
    } else if (const auto largest = std::max_element(circles.radii.begin(), circles.radii.end());
               radius < *largest) {
      *largest = radius;
    }
  }
  return circles;
}

}  // namespace lacuna::tangential
