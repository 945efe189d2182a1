// SPDX-License-Identifier: Apache-2.0
// consistency: finds which triangles of measured stars the stars of all their active vertices have.
#pragma once

#include "engine/boundary/tangential/stars.hpp"

#include <cstdint>
#include <span>

namespace lacuna::tangential {

// Links with at most this many vertices are compared in one step. As many are readable beyond the last link.
inline constexpr std::uint32_t kFewVertices = 8;

// Fills `consistencies`. A triangle is undecided where a vertex is active in the belt or may become active,
// and the stars of the others have it. Links of more than kFewVertices take longer. Cost: linear.
void decide_consistency(Stars<LocalIndex>& stars, std::span<const PointState> states);

// ---- For the kernel

// Stars by point, as in `Stars`.
struct StarTable {
  const StarRange* places;
  const LinkVertex<LocalIndex>* vertices;
  const PointState* states;
  Consistency* consistencies;
};

// The triangle that begins at a link vertex of the star of `point`.
struct TriangleQuery {
  std::uint32_t vertex;
  LocalIndex point, a, b;
};

}  // namespace lacuna::tangential
