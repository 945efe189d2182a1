// SPDX-License-Identifier: Apache-2.0
// emit_stars: what one tile alone knows of the stars of its points.
#pragma once

#include "engine/boundary/tangential/star_lists.hpp"
#include "engine/config/config.hpp"
#include "engine/evaluate/evaluated_tile.hpp"

#include <cstdint>
#include <vector>

namespace lacuna::tangential {

// Finds the stars of the tile's active points, and of those that other tiles may make active. Puts out
// certain wedges, open stars and the belt. Returns which owned points a loop may pass through.
std::vector<std::uint8_t> emit_stars(const EvaluatedTile& tile, const TangentialConfig& config,
                                     TileOutput& output);

// Takes what `emit_stars` has put out for a tile.
void absorb_stars(TileIndex index, const Tiling& tiling, const TileOutput& output, StarLists& lists);

}  // namespace lacuna::tangential
