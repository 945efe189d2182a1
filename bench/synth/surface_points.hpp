// SPDX-License-Identifier: Apache-2.0
// surface_points: the places of a surface's points in the plane of its grid, the holes among them, and the
// true loops of these.
//
// Idea: holes are ellipses, each inside of a cell of a coarse lattice. Points are near the nodes of the grid,
// or a Poisson process. A place depends on the seed and the number of its point alone. True loops are the
// edges of what is left of the grid, or the points nearest to a place that goes around a hole.
//
// Cost: constant for a point; the loops' points in memory.
#pragma once

#include "bench/synth/surface_grid.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace lacuna::synth {

// Each point has a number. It depends on the seed and its number alone, so points can be made in any order.
class Positions {
 public:
  virtual ~Positions() = default;

  // All numbers are below this one, in scanline order. Some of them have no point.
  virtual std::uint64_t size() const = 0;
  virtual std::optional<GridPosition> at(std::uint64_t number) const = 0;

  // Returns the numbers of the points around each hole, then along each outer edge, in order. Each loop is
  // closed, and visits no point twice.
  virtual std::vector<NumberLoop> true_loops() const = 0;
};

// Returns the positions that the options choose. Throws `Error` when the holes do not fit.
std::unique_ptr<Positions> make_positions(const SurfaceGrid& grid, const SurfaceOptions& options);

}  // namespace lacuna::synth
