// choose_scale: of the loops at both scales, those that stand (method.md, C.6).
//
// A coarse loop lies on a fine one that has at least a quarter of its points. Of two loops for the same place
// the surer stands. Where both are sure and sampling is even, both surround the same hole, and the fine loop
// is closer to its boundary. Where sampling is uneven, a fine loop may run through gaps of the sampling,
// which the coarse bound closes, from one hole to the next. Then it is longer than the coarse loops on it. So
// a sure fine loop also stands if the sure coarse loops on it are together nearly as long (`same_hole`).
#pragma once

#include "engine/loops/raw_loops.hpp"
#include "engine/run/job.hpp"

namespace lacuna::tangential {

// From this confidence on, a loop is sure: the default of `min_confidence`.
inline constexpr double kSure = 0.75;

// Adds the loops that stand and have `min_confidence` to `chosen`. Loops below both that and `kSure` change
// nothing, so a higher `min_confidence` gives a subset. Both inputs are sorted. Cost: sorts the points of all
// loops on disk.
void choose_scale(const RawLoops& fine, const RawLoops& coarse, const Job& job, RawLoops& chosen);

}  // namespace lacuna::tangential
