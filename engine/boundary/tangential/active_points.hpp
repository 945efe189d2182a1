// SPDX-License-Identifier: Apache-2.0
// active_points: which points of a tile are active, and their stars (method.md, C.4).
//
// A surface ends where triangles are missing. The search starts at the seeds, which are the surest of the
// paper's candidates (method.md, 4), and grows along inconsistent triangles. Seeds are active. The vertices
// of inconsistent triangles of an active point are active, too. A triangle is inconsistent if its
// circumradius is too large, or if the star of another active vertex does not have it. That is a least fixed
// point: neither the order of the search nor the tiles matter. Along a boundary wedge all points are active,
// which closes the boundary curves.
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

// `seeds` ascend; `is_border`: of owned points, has foreign neighbours. Cost: proportional to the active
// points and their neighbours, and one sweep over all points.
TileStars find_stars(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                     std::span<const Evaluation> evaluations, std::span<const LocalIndex> seeds,
                     std::span<const std::uint8_t> is_border, const TangentialConfig& config);

}  // namespace lacuna::tangential
