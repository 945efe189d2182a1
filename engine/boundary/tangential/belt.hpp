// SPDX-License-Identifier: Apache-2.0
// belt: the stars of a tile's border points and of their neighbours, which need what other tiles know.
#pragma once

#include "engine/boundary/tangential/star_exchange.hpp"
#include "engine/config/config.hpp"

#include <cstdint>

namespace lacuna::tangential {

// Replaces the samples of a tile's border points. The tiles must have published the sites of all rows of its
// belt.
void sample_border(StarExchange& exchange, TileIndex tile, const TangentialConfig& config);

// Adds the stars of a tile's belt to its open ones. Each star sends its triangles to the tiles of its foreign
// link vertices. The samples of all points of the belt's rows must be known.
void measure_belt(StarExchange& exchange, TileIndex tile, const TangentialConfig& config);

// Returns the memory that `sample_border` or `measure_belt` takes.
std::uint64_t belt_bytes(const StarExchange& exchange, TileIndex tile);

}  // namespace lacuna::tangential
