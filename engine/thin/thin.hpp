// SPDX-License-Identifier: Apache-2.0
// thin: makes a level on a lattice from the points of the level below, without the input.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/length_bins.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/thin/level.hpp"

#include <functional>
#include <optional>

namespace lacuna {

// Thins all points of a scan to the first level that the config's resolution or smallest hole wants. Throws
// `Error` where too few points are left to have neighbours.
Level thin_to_first(const Level& all, StoreFiles files, Job& job);

// Makes the level above, with one point for each cell of a lattice. Edges are powers of sqrt 2, so lattices
// do not depend on the scan. The edge is the first one that leaves about six in ten points. Returns nothing
// where too few points are left for a hole. `distances`: mean distances to the neighbours, of all points of
// the level below. `files` makes empty ones for the store, once the points are chosen.
std::optional<Level> thin_above(const Level& below, const LengthBins& distances,
                                const std::function<StoreFiles()>& files, Job& job);

// Returns whether a run with this config has levels above the first one. It has them unless the config names
// one level, or the method is the paper's.
bool has_levels(const Config& config);

}  // namespace lacuna
