// SPDX-License-Identifier: Apache-2.0
// Levels: the scan, and the scan thinned on ever coarser lattices (method.md, D).
//
// Where points are dense, a level makes them even; where they are sparse, it leaves them as they are. So each
// place is evaluated evenly at some level, from its own spacing upward.
#pragma once

#include "engine/bucket/split.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/survey/survey.hpp"
#include "engine/thin/store_chosen.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

struct Level {
  std::size_t number = 0;            // from 0
  double edge = 0;                   // of its lattice; 0: the level has every point
  SurveyedScan survey;               // of the whole scan
  double extent = 0;                 // the largest distance between points of the scan
  TileGuide guide;                   // how the points of the scan are cut into tiles
  TileJoin join;                     // how those tiles, or those of the level below, are put together
  TileStore store;                   // distinct points
  std::string evaluation;            // what its tiles are evaluated from; empty: no workspace is kept
  std::vector<std::uint64_t> input;  // of the first level: `PointSource::pass_counts`
  // Which point represents which. Only for a first level on a lattice, with results.points.
  std::optional<AppendLists<Represented>> represented;

  std::uint64_t tile_points() const { return edge > 0 ? join.tile_points : guide.tile_points; }
};

// Survey and bucket: all points. Where the config has a resolution, they are thinned to one for each cell of
// its lattice. Reads the input twice. An input that reads slowly is read once, and kept in the workspace
// meanwhile (engine/store/kept_scan.hpp). Where a kept workspace has the level, nothing is read.
// Throws `Error`.
Level first_level(PointSource& input, Job& job);

// The level above: made from the points of the one below, without the input. Edges are powers of sqrt 2, so
// that lattices do not depend on the scan. The edge is the first one that leaves about six in ten points.
// None where too few are left for a hole. `totals`: of the level below.
std::optional<Level> level_above(const Level& below, const Totals& totals, Job& job);

// So many levels at most: a level of 2^64 points has few left after so many.
inline constexpr std::size_t kMostLevels = 128;

// Whether a run with this config has levels above the first one: unless the config names one level, or the
// method is the paper's.
bool has_levels(const Config& config);

// So many points all levels above a first one have together, on a surface that is sampled evenly.
std::uint64_t points_above(const Level& first);

}  // namespace lacuna
