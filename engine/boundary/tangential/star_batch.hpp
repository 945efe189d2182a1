// The stars of a batch of points (stages/stars), and which of their triangles are agreed.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/simd/batch.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kMostSeen = 64;  // neighbours of one point

// Larger balls say no more, in units of `Sampling::distance`.
inline constexpr double kLargestBall = 8;

struct StarBatch {
  const Site* sites;  // of all points
  LocalIndex points[kBatchSize];
  const LocalIndex* neighbours[kBatchSize];  // where there are none: of any one point
  std::uint32_t counts[kBatchSize];          // of neighbours; 0: no star
  double normals[3][kBatchSize];             // unit; NaN: no star
};

struct BatchStars {
  static constexpr std::uint32_t kAmbiguous = UINT32_MAX;

  LinkVertex<LocalIndex> corners[kMostSeen][kBatchSize];  // by their numbers among the neighbours
  std::uint32_t sizes[kBatchSize];  // ambiguous: corners are so near to a line that rounding decides
  double distances[kBatchSize];     // `Sampling::distance`
};

void find_batch_stars(const StarBatch& batch, BatchStars& stars);

// Stars that are compared in one step have no more corners; as many are readable beyond the last star.
inline constexpr std::uint32_t kFewCorners = 8;

// Stars by point, as in `Stars`, and what becomes of their triangles.
struct StarTable {
  const StarPlace* places;
  const LinkVertex<LocalIndex>* corners;
  const PointState* states;
  Consistency* consistencies;
};

// A triangle that one of its corners, the first active one, asks the others for.
struct AskedTriangle {
  std::uint32_t corner;  // of the asking star
  LocalIndex point, a, b;
};

void compare_triangles(const StarTable& stars, const AskedTriangle* asked, std::size_t count);

}  // namespace lacuna
