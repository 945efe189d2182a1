// SPDX-License-Identifier: Apache-2.0
// Strays: a few points far from all others, such as returns at 0 0 0 in a scan of map coordinates.
#pragma once

#include "engine/model/detection.hpp"
#include "engine/store/tile_store.hpp"

namespace lacuna {

// The rule: on each side of each axis, the n / 1024 outermost of n distinct points are passed over, from 1 to
// 1024 of them. The others have a box. A stray lies outside of that box grown on all sides by `kFarFromRest`
// times its longest edge. There are no strays with fewer than `kFewestPoints` points, and where all others
// coincide.
//
// The result depends on the distinct points alone. Cost: linear in cells, and a read of the outermost ones.
// Where there are strays, all cells that reach out of the box are read.
Strays find_strays(const TileStore& store);

inline constexpr double kFarFromRest = 2;
inline constexpr std::uint64_t kFewestPoints = 64;

}  // namespace lacuna
