// SPDX-License-Identifier: Apache-2.0
// bucket: sorts the points into tiles on disk.
#pragma once

#include "engine/bucket/split.hpp"
#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/survey/survey.hpp"

namespace lacuna {

// Plans the tiles of a surveyed scan, as large as the memory limit allows. Consumes the survey's cells.
// Throws `Error` where the points do not fit on the disk.
TilePlan plan_tiles(SurveyedScan& survey, const Job& job);

// Streams the scan and stores every distinct finite point in its tile, in cell order. `bounds`: of all
// points. `files`: empty ones for the store.
TileStore bucket_scan(PointSource& scan, TilePlan plan, const Eigen::AlignedBox3d& bounds,
                      Precision precision, StoreFiles files, Job& job);

}  // namespace lacuna
