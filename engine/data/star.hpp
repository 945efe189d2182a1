// Stars of points: the triangles over which a ball can rest, and the gaps between them.
#pragma once

#include "engine/data/ids.hpp"

#include <cstdint>

namespace lacuna {

// Where a point stands on the surface: what the stars of its neighbours need to know of it.
struct alignas(64) Seat {
  double position[3];
  double shift[3];       // to the plane through its neighbours: takes noise out
  double mean_distance;  // r
  double weight;         // decides ties among points on one circle, alike for all of them
};

// Whether a point's star is looked for.
enum class Standing : std::uint8_t {
  kRough,   // yes: it or a neighbour is a suspect
  kInner,   // no: it agrees to every triangle
  kBorder,  // not yet: it has neighbours in other tiles
};

// A suspect has more than this Pi. Some of the points of a rim may have less, but then they have neighbours
// with more.
inline constexpr double kSuspicion = 0.2;

// One corner of a star, and the ball that rests on the star's point, this corner and the next one around.
template <class Name>
struct StarCorner {
  Name point;
  float room;  // the ball's radius in units of the radius that a triangle may have; at most 1: a triangle
};

// What is known of a triangle of a star: all its corners that are not inner must have it in their stars.
enum class Agreement : std::uint32_t { kRefused, kAgreed, kOpen };

// A point at the rim of the agreed triangles, and its neighbours along it. Between them, around the point,
// there is no agreed triangle; `room`: of the largest ball that rests there.
template <class Name>
struct Gap {
  Name point, from, to;
  float room;
  std::uint32_t padding = 0;  // written to disk: no byte is left to chance
};

}  // namespace lacuna
