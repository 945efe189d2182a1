// The star of a point: the Delaunay triangles around it, in its tangent plane (method.md, C.2).
#pragma once

#include "engine/model/ids.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace lacuna {

// A point of the surface as the stars around it need it: its weighted site.
struct alignas(64) Site {
  double position[3];
  double shift[3];   // to the plane through its neighbours: takes noise out
  double closeness;  // 1 / r
  double weight;     // decides ties among points on one circle, alike for all of them
};

// One vertex of a star's link, and the ball that rests on the star's point, this vertex and the next one
// around.
template <class Name>
struct LinkVertex {
  Name point;
  float radius;  // of the ball, in units of `Sampling::distance`
};

// How points lie around one.
struct Sampling {
  double distance = 0;  // harmonic mean of r over the point and its neighbours (strays, which are far from
                        // each other, count little); 0: the point has no star
  double circle = 0;    // median radius of its balls that lie among points; 0: there are none
  double spread = 0;    // and how far the smallest of these is below
};

// Which balls make a triangle, in units of `Sampling::distance`.
struct RadiusBound {
  float largest = 0;
  float unit = 1;  // of the excess radius

  // How much larger the ball is than a triangle's may be: excess radius.
  float excess(float radius) const { return (radius - largest) / unit; }
};

// Where a star's link is among the vertices of all. A star is measured once its bound is known.
struct StarPlace {
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
  // Of a measured star: whether the ball beyond link vertex i makes a triangle.
  bool is_triangle(std::size_t i) const { return link[i].radius <= bound.largest; }
  bool has_triangle(Name a, Name b) const {
    for (std::size_t i = 0; i < link.size(); ++i) {
      if (link[i].point != a) continue;
      const std::size_t before = i > 0 ? i - 1 : link.size() - 1;
      return (link[next(i)].point == b && is_triangle(i)) || (link[before].point == b && is_triangle(before));
    }
    return false;
  }
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

// Of a triangle of a star: the stars of all its active vertices must have it.
enum class Consistency : std::uint32_t { kInconsistent, kConsistent, kUndecided };

// visit(from, to, excess): each boundary wedge of a star's point, as in `Wedge`, with the largest excess
// radius in it. None where no triangle is consistent.
template <class Name, class Visit>
void for_each_wedge(const Star<Name>& star, std::span<const Consistency> consistencies, Visit&& visit) {
  const auto is_consistent = [&](std::size_t i) { return consistencies[i] == Consistency::kConsistent; };
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (!is_consistent(i) || is_consistent(star.next(i))) continue;
    std::size_t end = star.next(i);
    float largest = 0;
    for (; !is_consistent(end); end = star.next(end)) largest = std::max(largest, star.link[end].radius);
    visit(star.link[star.next(i)].point, star.link[end].point, std::max(0.0f, star.bound.excess(largest)));
  }
}

}  // namespace lacuna
