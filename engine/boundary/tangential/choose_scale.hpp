// choose_scale: of the loops at both scales, those that stand (method.md, C.6).
//
// A coarse loop lies on the fine one with which it shares most points. Where sampling is even, both surround
// the same hole, and the fine loop is closer to its boundary. Where sampling is uneven, a fine loop may run
// through gaps of the sampling, which the coarse bound closes, from one hole to the next. Then it is longer
// than the coarse loops on it. So the fine loop stands if these are together nearly as long (`same_hole`), or
// if none of them is surer. Otherwise they stand.
#pragma once

#include "engine/loops/raw_loops.hpp"
#include "engine/run/job.hpp"

namespace lacuna::tangential {

// Adds the loops that stand to `chosen`. Both inputs are sorted. Cost: sorts the points of all loops on disk.
void choose_scale(const RawLoops& fine, const RawLoops& coarse, const Job& job, RawLoops& chosen);

}  // namespace lacuna::tangential
