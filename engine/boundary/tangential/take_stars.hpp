// take_stars: what one tile alone knows of the stars of its points.
#pragma once

#include "engine/boundary/tangential/star_lists.hpp"
#include "engine/config.hpp"
#include "engine/evaluate/evaluated_tile.hpp"

#include <cstdint>
#include <vector>

namespace lacuna::tangential {

// Finds the stars of the tile's active points, and of those that other tiles may make active. Certain wedges,
// open stars and the belt go to the lists. Returns which owned points a loop may pass through.
std::vector<std::uint8_t> take_stars(const EvaluatedTile& tile, const Tiling& tiling,
                                     const TangentialConfig& config, StarLists& lists);

}  // namespace lacuna::tangential
