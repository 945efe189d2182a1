// The points of a tile store as a scan: what the level above is thinned from.
#pragma once

#include "engine/model/points.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <memory>

namespace lacuna {

// In the order of the store, with the ids of the input. `store` must outlive it.
std::unique_ptr<PointSource> read_store(const TileStore& store);

}  // namespace lacuna
