// The stars of points that wait for other tiles.
#pragma once

#include "engine/boundary/tangential/star_lists.hpp"

namespace lacuna {

// Goes on, from tile to tile, to look for active points along refused triangles until there are no more: then
// all wedges are known. All points have their sites. Stars that wait are found where a active point is near,
// and measured where one is active; after two rounds all of a tile that has news. So on clean scans the cost
// is that of the rims between tiles and of reading the lists once in each round. Consumes all but the wedges.
void exchange_borders(StarLists& lists, const Tiling& tiling, Job& job);

}  // namespace lacuna
