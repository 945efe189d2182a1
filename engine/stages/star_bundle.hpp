// Stars of eight points at once (stages/stars): plain arrays in, plain arrays out, so that the arithmetic can
// be compiled for each instruction set.
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/vector.hpp"
#include "engine/data/star.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kStarBundle = 8;  // points side by side
inline constexpr std::size_t kMostSeen = 64;   // neighbours of one of them

// Radius of the ball over the mean of r over p and its neighbours: about 1.2 spacings.
inline constexpr double kBall = 0.8;

// Larger ones say no more: there is room.
inline constexpr double kMostRoom = 8;

struct StarBundle {
  const Seat* seats;  // of all points
  LocalIndex points[kStarBundle];
  const LocalIndex* neighbours[kStarBundle];
  std::uint32_t counts[kStarBundle];  // of neighbours; 0: no star
  double normals[3][kStarBundle];     // unit; NaN: no star
};

struct BundledStars {
  static constexpr std::uint32_t kInDoubt = UINT32_MAX;

  StarCorner<LocalIndex> corners[kStarBundle][kMostSeen];  // by their numbers among the neighbours
  std::uint32_t sizes[kStarBundle];  // in doubt: corners are so near to a line that rounding decides
};

using FindBundledStars = void(const StarBundle&, BundledStars&);
LACUNA_DISPATCH(FindBundledStars, find_bundled_stars)

// ---- Formulas for one point or several

inline namespace LACUNA_LANES {

// Two directions in the tangent plane, counterclockwise about the normal.
template <class Real>
struct Frame {
  Vector<Real> u, v;
};

// Duff et al., Building an Orthonormal Basis, Revisited (2017).
template <class Real>
LACUNA_INLINE Frame<Real> frame_of(Vector<Real> normal) {
  const Real sign = select(normal.z < 0.0, Real{} - 1.0, Real{} + 1.0);
  const Real s = -1.0 / (sign + normal.z), t = normal.x * normal.y * s;
  return {{1.0 + sign * normal.x * normal.x * s, sign * t, -sign * normal.x},
          {t, sign + normal.y * normal.y * s, -normal.y}};
}

// Of a ball that rests on p and two neighbours, in units of `radius`. (x, y): where p sees one of them,
// inverted; (dx, dy): from there to where it sees the other.
template <class Real>
LACUNA_INLINE Real room_at(Real x, Real y, Real dx, Real dy, Real radius) {
  const Real height = x * dy - y * dx;  // times the length of (dx, dy)
  const Real room = root(dx * dx + dy * dy) / (2.0 * height * radius);
  const Real most = Real{} + kMostRoom;
  return select(height > 0.0, smaller(room, most), most);
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
