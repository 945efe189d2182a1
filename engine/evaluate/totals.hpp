// SPDX-License-Identifier: Apache-2.0
// totals: sums over the evaluated points of a tile, and of a level.
#pragma once

#include "engine/criteria/evaluation.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/model/detection.hpp"
#include "engine/model/length_bins.hpp"
#include "engine/model/neighbourhoods.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

__extension__ using Int128 = __int128;

// Sums over distinct points, exact in any order.
struct Totals {
  // `extent`: the largest distance between points of the scan.
  explicit Totals(double extent = 0);

  std::uint64_t points = 0;
  std::uint64_t neighbours = 0;  // of |N_p|
  std::uint64_t candidates = 0;  // Pi above the threshold
  std::uint64_t undefined_normals = 0;
  std::uint64_t normals_off = 0;
  ProbabilityBins probabilities{};
  Int128 edge_length = 0;  // over N_p of all p, in units of `length_unit`
  double length_unit = 1;
  LengthBins distances;   // mean distances to the neighbours, where there are any
  LengthBins half_discs;  // the same, twice for points that are not at a boundary

  double mean_neighbours() const;   // K
  double mean_edge_length() const;  // over the edges of G
  double median_distance() const { return distances.median(); }
  // Returns the area of the surface: the sum of the areas that its points stand for. A disc of 3/2 the mean
  // distance holds the neighbours of a point, and the point. As measured for k from 8 to 50, it holds 1.5
  // more. Neighbours of a point at a boundary fill half of it. Points whose neighbours are `far` count for
  // nothing. The area is within 3 % on even samplings.
  double surface_area(double far) const;
};

// Returns the sums of a tile. `extent`: the largest distance between points of the scan. `candidates` gets
// the points whose probability exceeds the threshold, ascending. One sweep finds both, since the evaluations
// do not fit in the cache.
Totals sum_up(std::span<const Evaluation> evaluations, const Neighbourhoods& neighbourhoods, double threshold,
              double extent, std::vector<LocalIndex>& candidates);

void emit_totals(const Totals& sums, TileOutput& output);

// Returns the sums of all tiles.
Totals read_totals(const TileOutputs& outputs, const Tiling& tiling, double extent);

// The sums as streams of a part.
void write_totals(const Totals& totals, PartWriter& part);
Totals read_totals(const PartReader& part, double extent);

}  // namespace lacuna
