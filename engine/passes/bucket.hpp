// The first two passes: where the points are, and the points themselves sorted into tiles on disk.
#pragma once

#include "engine/data/points.hpp"
#include "engine/passes/job.hpp"
#include "engine/stages/split.hpp"
#include "engine/stages/survey.hpp"
#include "engine/store/tile_store.hpp"

namespace lacuna {

// Streams the scan once and counts its points per cell.
SurveyedScan survey_scan(PointSource& scan, Job& job);

// Streams it again and stores every distinct finite point in its tile, in cell order. `bounds`: of all
// points.
TileStore bucket_scan(PointSource& scan, TilePlan plan, const Eigen::AlignedBox3d& bounds,
                      Precision precision, Job& job);

}  // namespace lacuna
