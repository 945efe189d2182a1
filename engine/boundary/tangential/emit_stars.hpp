// SPDX-License-Identifier: Apache-2.0
// emit_stars: finds what one tile alone knows of the stars of its points.
#pragma once

#include "engine/boundary/tangential/star_streams.hpp"
#include "engine/config/config.hpp"
#include "engine/evaluate/evaluated_tile.hpp"

namespace lacuna::tangential {

// Finds the stars of the tile's active points, and of points that other tiles may make active. Emits
// certain wedges, open stars and the belt.
void emit_stars(const EvaluatedTile& tile, const TangentialConfig& config, TileOutput& output);

}  // namespace lacuna::tangential
