// SPDX-License-Identifier: Apache-2.0
// evaluate, over all tiles: every point evaluated from its neighbourhood (paper, 4.1 to 4.6).
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/halo/halo.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>

namespace lacuna {

__extension__ using Int128 = __int128;

// Counts positive numbers in bins. Each power of two has 64 bins. Bins are in the order of the numbers.
struct LengthBins {
  static constexpr int kShift = 46;  // bits of a number within a bin
  std::map<std::uint32_t, std::uint64_t> counts;

  static std::uint32_t bin_of(double length);  // positive
  static double start_of(std::uint32_t bin);   // the shortest of the bin
  // Returns the median, as if the numbers of a bin were spread evenly over it. 0 without any number.
  double median() const;
  // Within 1.6 %.
  double sum_of_squares() const;
};

// Mean distance of a point to its neighbours over the spacing, on a square grid with k = 15.
inline constexpr double kDistanceOverSpacing = 1.7;

// Sums over all distinct points, exact in any order.
struct Totals {
  // `extent`: the largest distance between points of the scan.
  explicit Totals(double extent = 0);
  // The sums of a tile. By one thread at a time.
  void add(const TileOutput& output);

  std::uint64_t points = 0;
  std::uint64_t neighbours = 0;  // of |N_p|
  std::uint64_t candidates = 0;  // Pi above the threshold
  std::uint64_t undefined_normals = 0;
  ProbabilityBins probabilities{};
  Int128 edge_length = 0;  // over N_p of all p, in units of `length_unit`
  double length_unit = 1;
  LengthBins distances;  // mean distances to the neighbours, where there are any

  double mean_neighbours() const;   // K
  double mean_edge_length() const;  // over the edges of G
  double median_distance() const { return distances.median(); }
  // The surface, where its points are even: the sum of the areas that they stand for. A disc of 3/2
  // the mean distance holds its neighbours, the point and, as measured for k from 8 to 50, 1.5 more. Within
  // 2 % on even samplings; points near a boundary count for more.
  double surface_area() const;
};

// Evaluates these tiles: take(tile, output), from several threads at once. Consumes the halo. `eps`: a
// length, 0: off. `extent`: the largest distance between points of the scan. `find_known`: an output of the
// tile, if one with this content is known; only where a workspace is kept.
void evaluate_tiles(
    const TileStore& store, std::span<const TileIndex> tiles, AppendLists<HaloEdge> halo, double eps,
    double extent, std::span<TileConsumer* const> consumers, Job& job,
    const std::function<void(TileIndex, const TileOutput&)>& take,
    const std::function<std::optional<TileOutput>(TileIndex, const TileContent&)>& find_known);

}  // namespace lacuna
