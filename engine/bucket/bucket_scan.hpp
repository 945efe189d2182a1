// SPDX-License-Identifier: Apache-2.0
// bucket: the points sorted into tiles on disk.
#pragma once

#include "engine/bucket/split.hpp"
#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"

namespace lacuna {

// Streams the scan and stores every distinct finite point in its tile, in cell order. `bounds`: of all
// points. `files`: empty ones for the store.
TileStore bucket_scan(PointSource& scan, TilePlan plan, const Eigen::AlignedBox3d& bounds,
                      Precision precision, StoreFiles files, Job& job);

}  // namespace lacuna
