// The stars of points that wait for other tiles.
#pragma once

#include "engine/boundary/tangential/star_lists.hpp"

namespace lacuna {

// Goes on, from tile to tile, to look for rough points along refused triangles until there are no more: then
// all gaps are known. All points have their seats. Stars that wait are found where a rough point is near, and
// measured where one is rough; after two rounds all of a tile that has news. So on clean scans the cost is
// that of the rims between tiles and of reading the lists once in each round. Consumes all but the gaps.
void settle_seams(StarLists& lists, const Tiling& tiling, Job& job);

}  // namespace lacuna
