// SPDX-License-Identifier: Apache-2.0
// The steps that make the first level: survey, bucket, thin. One process does them, or several tasks that
// each read parts of the scan (sealed_scan.hpp).
#pragma once

#include "engine/model/points.hpp"
#include "engine/model/task_share.hpp"
#include "engine/run/job.hpp"
#include "engine/thin/level.hpp"
#include "engine/workspace/workspace.hpp"

namespace lacuna {

// Returns the points of the first level. Takes from the workspace what is there. Where the config has a
// resolution, one point is left for each cell of its lattice. Reads the input twice, or once where it reads
// slowly. Throws `Error`.
Level first_level(PointSource& scan, const Workspace& workspace, Job& job);

// Returns whether tasks can share the reading of the scan. It has parts, and all of its points are in the
// level.
bool can_share_reading(const PointSource& scan, const Config& config);

// The steps of tasks. Each does nothing where its part is there, and makes what it lacks of the steps before.
void survey_share(PointSource& scan, const TaskShare& share, const Workspace& workspace, Job& job);
void plan_shared_tiles(PointSource& scan, const Workspace& workspace, Job& job);
void scatter_share(PointSource& scan, const TaskShare& share, const Workspace& workspace, Job& job);
void store_share(PointSource& scan, const TaskShare& share, const Workspace& workspace, Job& job);

}  // namespace lacuna
