// choose_resolution: what a scan can resolve, from a sample of its points.
#pragma once

#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"

namespace lacuna {

// The resolution that noise and scan lines leave (`resolution_of`); 0: every point counts, as in a scan of
// fewer than a thousand points. The sample is the
// same for every tiling and every order of the points: those whose coordinates have the lowest hashes. Cost:
// one pass over the store, and the neighbours of a thousand points.
double choose_resolution(const TileStore& store, Job& job);

}  // namespace lacuna
