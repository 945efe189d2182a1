// SPDX-License-Identifier: Apache-2.0
// thin: makes a level on a lattice from the points of the level below, without the input.
#pragma once

#include "engine/config/config.hpp"
#include "engine/config/job.hpp"
#include "engine/model/length_bins.hpp"
#include "engine/store/store_writer.hpp"
#include "engine/thin/level.hpp"

#include <cstdint>

namespace lacuna {

// Thins all points of a scan to the first level that the config's resolution or smallest hole wants. Throws
// `Error` where too few points are left to have neighbours.
Level thin_to_first(const Level& all, StoreFiles files, Job& job);

// Returns the edge of the level above: the first power of sqrt 2 that leaves about six in ten points. So
// lattices do not depend on the scan. It is 0 where no point has a neighbour. `distances`: mean distances to
// the neighbours, of all points of the level below.
double edge_above(const Level& below, const LengthBins& distances);

// Makes a task's share of the level above, with one point for each cell of a lattice.
Level thin_above(const Level& below, const TaskShare& share, double edge, StoreFiles files, Job& job);

// A level of fewer points leaves no interior around a hole, and is none.
inline constexpr std::uint64_t kFewestOfLevel = 200;

// Returns whether a run with this config has levels above the first one. It has them unless the config names
// one level, or the method is the paper's.
bool has_levels(const Config& config);

}  // namespace lacuna
