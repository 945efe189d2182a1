// SPDX-License-Identifier: Apache-2.0
// The stars of the belts, between tiles.
#pragma once

#include "engine/boundary/tangential/star_lists.hpp"

namespace lacuna::tangential {

// Completes the wedges of all tiles, once each has taken its own stars. Consumes all lists but the wedges and
// the active points.
//
// Active points are a least fixed point (method.md, C.4). So tiles may grow them in any order, and again
// while a neighbouring tile has new ones. A tile takes part once a point of its belt is active. Then its belt
// is measured, after the borders of the tiles around it are sampled. Cost: the stars of these belts, and the
// open stars once in each round.
void exchange_borders(StarLists& lists, const Tiling& tiling, Job& job);

}  // namespace lacuna::tangential
