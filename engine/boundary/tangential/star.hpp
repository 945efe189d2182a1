// Stars of points: the triangles over which a ball can rest.
#pragma once

#include "engine/model/ids.hpp"

#include <cstdint>

namespace lacuna {

// Where a point stands on the surface: what the stars of its neighbours need to know of it.
struct alignas(64) Site {
  double position[3];
  double shift[3];   // to the plane through its neighbours: takes noise out
  double closeness;  // 1 / r
  double weight;     // decides ties among points on one circle, alike for all of them
};

// What is known of a point in its tile. The stars of active points must have the triangles that they are part
// of.
enum class PointState : std::uint8_t {
  kInactive,   // not active: it agrees to every triangle
  kActive,   // active, and its star is measured
  kMaybeActive,  // likewise measured; it may become active by what is told in other tiles
  kBeside,  // its star is found, and measured later: it has neighbours at the border
  kBorder,  // its star is found later: it has neighbours in other tiles
};

inline bool is_measured(PointState state) {
  return state == PointState::kActive || state == PointState::kMaybeActive;
}
inline bool waits(PointState state) {
  return state == PointState::kBeside || state == PointState::kBorder;
}

// One corner of a star, and the ball that rests on the star's point, this corner and the next one around.
template <class Name>
struct LinkVertex {
  Name point;
  // Of a star as it is found, the ball's radius in units of `Sampling::distance`; of a measured one, how much
  // larger it is than a triangle may be, in units of `RadiusBound`: at most 0, and it is a triangle.
  float room;
};

// Where a star is among the corners of all.
struct StarPlace {
  std::uint32_t begin = 0, size = 0;
};

// How points lie around one.
struct Sampling {
  double distance = 0;  // harmonic mean of r over the point and its neighbours (strays, which are far from
                        // each other, say little); 0: it has no star
  double circle = 0;    // of the radii of its balls that lie among points the median; 0: it has none such
  double scatter = 0;   // and how far the least is below
};

// What a ball may be to make a triangle.
struct RadiusBound {
  double radius;
  double unit;  // of the room beyond
};

// What is known of a triangle of a star: all its active corners must have it in their stars.
enum class Consistency : std::uint32_t { kInconsistent, kConsistent, kUndecided };

}  // namespace lacuna
