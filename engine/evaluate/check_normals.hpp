// SPDX-License-Identifier: Apache-2.0
// check_normals: whether the normals that points came with fit the points.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/tile_store.hpp"

namespace lacuna {

// Compares given normals with normals that are estimated from the k nearest neighbours, at an even sample of
// about 2,000 points. The ids decide which points are sampled, so the result does not depend on the tiling.
// Points whose neighbourhood is no surface do not count. Cost: one pass over the points, and a search for
// each sampled one.
GivenNormals check_normals(const TileStore& store, const Config& config, const TaskArena& arena);

}  // namespace lacuna
