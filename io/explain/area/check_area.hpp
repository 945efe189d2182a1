// SPDX-License-Identifier: Apache-2.0
// check_area: the voids of a scan within an area.
//
// Idea: what no point covers is empty (empty_places.hpp). Circles around that are the voids.
#pragma once

#include "engine/export.hpp"
#include "engine/run/progress.hpp"
#include "io/explain/area/area.hpp"
#include "io/explain/area/area_check.hpp"

namespace lacuna::io {

// A place is empty if no point lies nearer to it than half of the void size, seen from above. Voids are what
// the circles around empty places cover within the area.
//
// The area has cells, whose edge is an eighth of the void size, and some are empty
// (empty_places.hpp). Voids are made of the cells near them: the middles of both are at most half of
// the void size apart. Cells that share edges are one void. The convex hull of the points in the bounds of
// the area cuts voids.
//
// The result names why the points do not decide, if they do not: see `Undecided`. Voids are listed all the
// same.
//
// A void counts unless all of its empty cells lie in exceptions. Where a file of the scan has return
// numbers, only first returns are points. Points of the flag synthetic cover nothing, unless the scan has no
// others. Points of about the same x, y, z and time count once. (Data voids in the Lidar Base Specification
// of the U.S. Geological Survey: its least void has four nominal pulse spacings.)
//
// Points whose heights lie apart cover nothing (point_rules.hpp), unless the config has bounds of
// heights. The gap is 100 m, or ten void sizes if that is more. Structures leave no such gap between their
// points and those of the ground, but for lone roofs.
//
// Reads the scan once or twice, and once or twice more where heights lie apart or points do not fit in
// memory. Memory: 3 or 4 bits for each cell in the bounds of the area, and the outlines. Cost: linear in
// points and in cells. Throws `Error` where outlines do not fit in memory.
LACUNA_API AreaCheck check_area(Area area, const ScanFiles& scan, const FilesConfig& config,
                                Progress& progress);

// Checks the area of the config, or the scan's own outline (area.hpp). The outline is never
// `covered`, but covered within itself, or not decided where it has several polygons or leaves out a bay. Its
// polygons are checked in their groups, and each group reads the scan like an area. Throws `Error`.
LACUNA_API AreaCheck check_scan(const ScanFiles& scan, const FilesConfig& config, Progress& progress);

}  // namespace lacuna::io
