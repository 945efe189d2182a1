// SPDX-License-Identifier: Apache-2.0
// bucket: sorts the points into tiles on disk.
#pragma once

#include "engine/bucket/split.hpp"
#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/survey/survey.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace lacuna {

// Plans the tiles of a surveyed scan, as large as the memory limit allows. Consumes the survey's cells.
// Throws `Error` where the points do not fit on the disk.
TilePlan plan_tiles(SurveyedScan& survey, const Job& job);

// Streams the scan and stores every distinct finite point in its tile, in cell order. `bounds`: of all
// points. `files`: empty ones for the store.
TileStore bucket_scan(PointSource& scan, const TilePlan& plan, const Eigen::AlignedBox3d& bounds,
                      Precision precision, StoreFiles files, Job& job);

// Several tasks may do so, in two steps: they scatter the points of parts of the scan, and then store tiles.

// Points on their way to a place. Places are the tiles of the plan, and then its groups of points that are set
// aside.
struct ScatteredPoints {
  std::vector<StoredPoint> points;
  std::vector<StoredNormal> normals;
};
// Streams the scan, and hands points to their places: take(place, points, normals). Places of tiles get
// points from any thread, and others from one thread at a time.
using TakePoints =
    std::function<void(std::size_t, std::span<const StoredPoint>, std::span<const StoredNormal>)>;
void scatter_points(PointSource& scan, const TilePlan& plan, const TakePoints& take, Job& job);

// Stores a task's tiles. The last task stores the points that are set aside, too. for_each(place, visit)
// calls visit(scattered) once or several times with all points of a place.
using VisitPoints = std::function<void(const ScatteredPoints&)>;
TileStore store_tiles(const TilePlan& plan, const TaskShare& share, const Eigen::AlignedBox3d& bounds,
                      Precision precision, bool with_normals,
                      const std::function<void(std::size_t, const VisitPoints&)>& for_each, StoreFiles files,
                      Job& job);

}  // namespace lacuna
