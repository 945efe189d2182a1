// Stars of eight points at once (stages/stars): plain arrays in, plain arrays out, so that the arithmetic can
// be compiled for each instruction set.
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/eight.hpp"
#include "engine/core/vector.hpp"
#include "engine/data/star.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kStarBundle = kEight;  // points side by side
inline constexpr std::size_t kMostSeen = 64;        // neighbours of one of them

// Larger balls say no more, in units of `Sampling::distance`.
inline constexpr double kLargestBall = 8;

struct StarBundle {
  const Seat* seats;  // of all points
  LocalIndex points[kStarBundle];
  const LocalIndex* neighbours[kStarBundle];  // where there are none: of any one point
  std::uint32_t counts[kStarBundle];          // of neighbours; 0: no star
  double normals[3][kStarBundle];             // unit; NaN: no star
};

struct BundledStars {
  static constexpr std::uint32_t kInDoubt = UINT32_MAX;

  StarCorner<LocalIndex> corners[kMostSeen][kStarBundle];  // by their numbers among the neighbours
  std::uint32_t sizes[kStarBundle];  // in doubt: corners are so near to a line that rounding decides
  double distances[kStarBundle];     // `Sampling::distance`
};

using FindBundledStars = void(const StarBundle&, BundledStars&);
LACUNA_DISPATCH(FindBundledStars, find_bundled_stars)

// Stars that are compared in one step have no more corners; as many are readable beyond the last star.
inline constexpr std::uint32_t kFewCorners = 8;

// Stars by point, as in `Stars`, and what becomes of their triangles.
struct StarTable {
  const StarPlace* places;
  const StarCorner<LocalIndex>* corners;
  const Standing* standings;
  Agreement* agreements;
};

// A triangle that one of its corners, the first rough one, asks the others for.
struct AskedTriangle {
  std::uint32_t corner;  // of the asking star
  LocalIndex point, a, b;
};

using AgreeOnTriangles = void(const StarTable&, const AskedTriangle* asked, std::size_t count);
LACUNA_DISPATCH(AgreeOnTriangles, agree_on_triangles)

// ---- Formulas for one point or several

inline namespace LACUNA_LANES {

// The radius of a ball that rests on p and two neighbours, in units of `distance`. (x, y): where p sees one
// of them, inverted; (dx, dy): from there to where it sees the other.
template <class Real>
LACUNA_INLINE auto ball_at(Real x, Real y, Real dx, Real dy, Real distance) {
  // Both without a unit. From here on in single precision, which is what is kept: roots and quotients take a
  // quarter of the time.
  const Real unit = distance * distance;
  const auto squared_length = single((dx * dx + dy * dy) * unit);
  const auto height = single((x * dy - y * dx) * (2.0 * unit));  // times the length
  const auto ball = root(squared_length) / height;
  const auto largest = decltype(ball){} + static_cast<float>(kLargestBall);
  return select(height > 0.0F, smaller(ball, largest), largest);
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
