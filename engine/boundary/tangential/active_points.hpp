// tile_stars: which points of a tile are active, and their stars.
//
// A surface ends where triangles are missing. So the search starts at the seeds, which are the paper's
// candidates (method.md, 4): points with Pi above the threshold. It goes on from triangle to triangle along
// what is missing: seeds are active, and where a triangle in the star of a active point is refused (its ball is
// too large, or the star of another active corner has it not), all its corners are active. That is a least
// fixed point: it does not matter in which order it is reached, nor by which tile. Along a wedge between agreed
// triangles all points are active, which is what closes the rims.
#pragma once

#include "engine/config.hpp"
#include "engine/criteria/evaluation.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/model/points.hpp"
#include "engine/boundary/tangential/stars.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// Of a tile's owned points, as far as the tile alone can tell. All those that may be active, whatever other
// tiles tell, are measured or wait: the border and its neighbours do, and from them on the search takes any
// triangle for refused that may be.
struct TileStars {
  std::vector<PointState> states;
  std::vector<std::uint8_t> is_active;  // for certain
  // Measured ones, with an consistency on each triangle, open where a corner waits or is unsure. Those beside
  // the border as found, and open. Others were found for their samplings only: nothing is agreed.
  Stars<LocalIndex> stars;
  std::vector<Sampling> samplings;
};

inline bool is_seed(const Evaluation& evaluation, double threshold) {
  return evaluation.probability > threshold;
}

// `is_border`: of owned points, has foreign neighbours. Cost: proportional to the active points and their
// neighbours, and a look at each point.
TileStars find_stars(const TilePoints& points, const Rows& neighbourhoods,
                     std::span<const Evaluation> evaluations, std::span<const std::uint8_t> is_border,
                     double threshold, const TangentialConfig& config);

}  // namespace lacuna
