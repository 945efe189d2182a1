// SPDX-License-Identifier: Apache-2.0
// Levels: the scan, and the scan thinned on ever coarser lattices (method.md, D).
//
// Where points are dense, a level makes them even; where they are sparse, it leaves them as they are. So each
// place is evaluated evenly at some level, from its own spacing upward.
#pragma once

#include "engine/model/length_bins.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/survey/survey.hpp"
#include "engine/thin/choose_points.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

struct Level {
  std::size_t number = 0;               // from 0
  double edge = 0;                      // of its lattice; 0: the level has every point
  SurveyTotals survey;                  // of the whole scan
  double extent = 0;                    // the largest distance between points of the scan
  std::uint64_t tile_points = 0;        // the most in a tile
  TileStore store;                      // distinct points
  std::optional<LengthBins> distances;  // mean ones to the neighbours; none until the level is evaluated
  std::string seal;                     // the checksums of its parts, a line each; empty: it is not kept
  std::vector<std::uint64_t> input;     // of the first level: `PointSource::pass_counts`
  // Which point represents which. Only for a first level on a lattice, with results.points.
  std::optional<AppendLists<Represented>> represented;
};

// A run has at most this many levels: a level of 2^64 points has few left after them.
inline constexpr std::size_t kMostLevels = 128;

}  // namespace lacuna
