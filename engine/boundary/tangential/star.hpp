// SPDX-License-Identifier: Apache-2.0
// The star of a point: the Delaunay triangles around it, in its tangent plane (method.md, C.1).
#pragma once

#include "engine/model/ids.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna::tangential {

// A point of the surface in the form that the stars around it need: its weighted site.
struct alignas(64) Site {
  double position[3];
  double shift[3];   // to the plane through its neighbours: takes noise out
  double closeness;  // 1 / r
  double weight;     // decides ties among points on one circle, alike for all of them
};

// Larger circumradii count as this one, in units of `Sampling::distance`.
inline constexpr double kLargestRadius = 8;

// One vertex of a star's link, and the circumradius of the triangle of the star's point, this vertex and the
// next one around.
template <class Name>
struct LinkVertex {
  Name point;
  float radius;  // in units of `Sampling::distance`
};

// How points lie around a point.
struct Sampling {
  double distance = 0;  // harmonic mean of r over the point and its neighbours (strays, which are far from
                        // each other, count little); 0: the point has no star
  double median_radius = 0;  // median circumradius of its triangles that lie among points; 0: there are none
  double spread = 0;         // distance from the median down to the smallest of them
};

// The circumradius bound that a triangle keeps to. Curves are found at both bounds (method.md, C.2 and C.6).
enum class Scale : std::uint8_t {
  kFine,
  kCoarse,  // it keeps to the coarse bound, not to the fine one
  kNone,    // it keeps to neither: it is no triangle of the surface
};
inline constexpr std::array kScales{Scale::kFine, Scale::kCoarse};

// The largest circumradii of triangles, in units of `Sampling::distance`.
struct RadiusBound {
  float fine = 0, coarse = 0;

  float at(Scale scale) const { return scale == Scale::kFine ? fine : coarse; }
  Scale scale_of(float radius) const {
    return radius <= fine ? Scale::kFine : radius <= coarse ? Scale::kCoarse : Scale::kNone;
  }
};

// Where a star's link is among the vertices of all links. A star is measured once its bound is known.
struct StarRange {
  std::uint32_t begin = 0, size = 0;
  RadiusBound bound;
};

// A star whose link vertices are in counterclockwise order about the normal.
template <class Name>
struct Star {
  std::span<const LinkVertex<Name>> link;
  RadiusBound bound;

  std::size_t size() const { return link.size(); }
  std::size_t next(std::size_t i) const { return i + 1 < link.size() ? i + 1 : 0; }
  // The bound that the triangle beyond link vertex i of a measured star keeps to.
  Scale scale_of(std::size_t i) const { return bound.scale_of(link[i].radius); }
  // Returns the bound of the triangle with a and b, and kNone if the star does not have it.
  Scale scale_of(Name a, Name b) const {
    for (std::size_t i = 0; i < link.size(); ++i) {
      if (link[i].point != a) continue;
      const std::size_t before = i > 0 ? i - 1 : link.size() - 1;
      Scale scale = link[next(i)].point == b ? scale_of(i) : Scale::kNone;
      if (link[before].point == b) scale = std::min(scale, scale_of(before));
      return scale;
    }
    return Scale::kNone;
  }
  // Within the fine bound.
  bool is_triangle(std::size_t i) const { return scale_of(i) == Scale::kFine; }
  bool has_triangle(Name a, Name b) const { return scale_of(a, b) == Scale::kFine; }
};

// What a tile knows of a point. The stars of active points must have the triangles that they are part of.
enum class PointState : std::uint8_t {
  kInactive,     // never active: it is consistent with every triangle
  kActive,       // active, and its star is measured
  kMaybeActive,  // measured; active points of other tiles may make it active
  kInner,        // of the belt: it has neighbours at the border, so its star is found here, but not measured
  kBorder,       // of the belt: it has neighbours in other tiles, so its star is not found here
};

inline bool is_measured(PointState state) {
  return state == PointState::kActive || state == PointState::kMaybeActive;
}
// The belt of a tile: its stars need what other tiles know.
inline bool is_in_belt(PointState state) {
  return state == PointState::kInner || state == PointState::kBorder;
}

// The consistency of a triangle of a star. `scale` is the bound within which the stars of all its active
// vertices have it. While it is undecided, vertices in other tiles may still raise the scale.
struct Consistency {
  Scale scale = Scale::kNone;
  bool is_undecided = false;

  bool at(Scale bound) const { return scale <= bound; }
};

// Calls visit(first, last, radius) for each boundary wedge of a star's point at a scale. A wedge is given by
// its first and last link vertex, with the largest circumradius between them. There is no wedge where no
// triangle is consistent.
template <class Name, class Visit>
void for_each_wedge(const Star<Name>& star, std::span<const Consistency> consistencies, Scale scale,
                    Visit&& visit) {
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (!consistencies[i].at(scale) || consistencies[star.next(i)].at(scale)) continue;
    const std::size_t first = star.next(i);
    std::size_t last = first;
    float largest = 0;
    for (; !consistencies[last].at(scale); last = star.next(last))
      largest = std::max(largest, star.link[last].radius);
    visit(first, last, largest);
  }
}

}  // namespace lacuna::tangential
