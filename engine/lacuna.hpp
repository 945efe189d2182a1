// SPDX-License-Identifier: Apache-2.0
// Lacuna as a library: `#include <lacuna/lacuna.hpp>`. This header and the headers that it includes have
// everything that a user needs.
//
// - Points in memory: `find_holes`, below.
// - A scan larger than memory: derive from `PointSource` (engine/model/points.hpp), and call `detect`
//   (engine/pipeline.hpp). It returns the same results as streams (engine/model/detection.hpp).
// - Parameters: `Config` (engine/config/config.hpp), one struct per stage with its defaults. `parameters`
//   lists them by name, `read_config` (engine/config/config_file.hpp) reads them from a file.
// - Errors: `Error` (engine/run/error.hpp), one line of text for the user.
//
// Results are the same bytes for every number of threads and every memory limit. The program calls the same
// functions and has the same results. Source of the method: docs/method.md.
#pragma once

#include "engine/config/config.hpp"
#include "engine/config/config_file.hpp"
#include "engine/export.hpp"
#include "engine/model/detection.hpp"
#include "engine/model/points.hpp"
#include "engine/pipeline.hpp"
#include "engine/points_in_memory.hpp"
#include "engine/run/error.hpp"
#include "engine/run/progress.hpp"

#include <vector>

namespace lacuna {

// All results of a run, in memory. A point's id is its index in the input.
struct Holes {
  std::vector<ReportedLoop> loops;  // in order of (first id, length, ids): holes and outer boundaries
  std::vector<PointResult> points;  // one per point of the input, in its order; only with `results.points`
  Summary summary;                  // counts, bounds, and the parameters in effect
};

// Finds the loops around the holes of the surface that `points` sample, in any unit of length. All lengths of
// the results are in the same unit. Non-finite points are dropped and counted. Empty input, and fewer points
// than a hole needs, give no loops. A vector or span of Eigen::Vector3d or Vector3f is a `PointArray`. So are
// records with three coordinates at fixed strides.
//
// `config`: `input` is for files and has no effect; `points` is the only value of `output` that counts.
// `progress`: is called as in engine/run/progress.hpp; an exception that it throws ends the run.
// Throws `Error` for parameters that contradict each other, for a coordinate beyond `kFarthest`, and where
// the scratch folder cannot be made or written to.
//
// Temporary data of a run goes to a folder in `run.scratch`, or in the system's folder for temporary files.
// The run removes that folder at its end.
//
// Cost: time is nearly linear in the points of a surface. Memory holds the input, the results, and what
// `run.memory_limit` allows. A folder takes some 100 bytes per point (docs/usage.md says how many). Calls
// from several threads are independent of each other.
LACUNA_API Holes find_holes(const PointArray& points, const Config& config = {},
                            Progress* progress = nullptr);

// Finds the loops with known normals. There is one normal per point, of any length. A normal that is not
// known is NaN or zero. Throws `Error` too where the number of normals differs from the number of points.
LACUNA_API Holes find_holes(const PointArray& points, const PointArray& normals, const Config& config = {},
                            Progress* progress = nullptr);

// Finds the loops of any source. It may be larger than memory where its loops are not, and where
// `results.points` is off.
LACUNA_API Holes find_holes(PointSource& scan, const Config& config = {}, Progress* progress = nullptr);

}  // namespace lacuna
