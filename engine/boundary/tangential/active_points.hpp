// SPDX-License-Identifier: Apache-2.0
// active_points: which points of a tile are active, their stars, and which triangles are consistent
// (method.md, C.3 and C.4).
//
// Idea: a surface ends where triangles are missing. The search starts at the seeds, which are the surest of
// the paper's candidates (method.md, 4), and grows along inconsistent triangles. So the interior, which is
// most of a scan, costs nothing.
//
// Seeds are active. The vertices of inconsistent triangles of an active point are active, too. A triangle is
// inconsistent if its circumradius is too large, or if the star of another active vertex does not have it.
// That is a least fixed point: neither the order of the search nor the tiles matter.
//
// Triangles of one star never overlap, so consistent triangles are a surface with boundary whatever the
// noise. An edge has at most two consistent triangles. Around each point, fans of triangles and boundary
// wedges alternate. Each end of a wedge is an edge with one triangle, and ends exactly one wedge at its other
// end. So along a boundary all points are active, and boundary curves are closed.
//
// Source: Shewchuk, Star splaying, SoCG 2005 (stars found apart and compared); hysteresis: Canny, A
// computational approach to edge detection, PAMI 1986.
// Cost: proportional to the active points and their neighbours, and one sweep over all points.
#pragma once

#include "engine/boundary/tangential/stars.hpp"
#include "engine/config/config.hpp"
#include "engine/criteria/evaluation.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/model/points.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::tangential {

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

// Where a star's link is among the vertices of all links. A star is measured once its bound is known.
struct StarRange {
  std::uint32_t begin = 0, size = 0;
  RadiusBound bound;
};

// Stars of points 0, 1, 2, ...; `consistencies` has a value for the triangle that begins at each link vertex.
template <class Name>
struct Stars {
  std::vector<StarRange> places;
  std::vector<LinkVertex<Name>> vertices;
  std::vector<Consistency> consistencies;

  std::size_t size() const { return places.size(); }
  Star<Name> operator[](std::size_t p) const {
    return {{vertices.data() + places[p].begin, places[p].size}, places[p].bound};
  }
  std::span<const Consistency> consistencies_of(std::size_t p) const {
    return {consistencies.data() + places[p].begin, places[p].size};
  }
  std::span<Consistency> consistencies_of(std::size_t p) {
    return {consistencies.data() + places[p].begin, places[p].size};
  }
};

// The stars of a tile's owned points, as far as the tile alone knows. Points that other tiles may make active
// are measured or in the belt. After the belt, the search takes each triangle for inconsistent that may turn
// out so.
struct TileStars {
  std::vector<PointState> states;
  std::vector<std::uint8_t> is_active;  // for certain
  // Measured stars, with the consistency of each triangle. Other stars are found for their samplings only.
  Stars<LocalIndex> stars;
  std::vector<Sampling>
      samplings;  // of measured and inner points, and of all their neighbours but border points
};

// `seeds` ascend; `is_border`: of owned points, has foreign neighbours.
TileStars find_stars(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                     std::span<const Evaluation> evaluations, std::span<const LocalIndex> seeds,
                     std::span<const std::uint8_t> is_border, const TangentialConfig& config);

// ---- For the kernel of consistency (consistency.cpp)

// Links with at most this many vertices are compared in one step. As many are readable beyond the last link.
inline constexpr std::uint32_t kFewVertices = 8;

// Fills `consistencies`. A triangle is undecided where a vertex is active in the belt or may become active,
// and the stars of the others have it. Links of more than kFewVertices take longer. Cost: linear.
void decide_consistency(Stars<LocalIndex>& stars, std::span<const PointState> states);

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
