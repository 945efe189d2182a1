// SPDX-License-Identifier: Apache-2.0
// Places of the points of a synthetic surface, in the plane of its grid.
#pragma once

#include "bench/synth/hole_field.hpp"
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

// Returns the positions that the options choose. Both arguments must outlive the result.
std::unique_ptr<Positions> make_positions(const SurfaceGrid& grid, const HoleField& holes,
                                          const SurfaceOptions& options);

}  // namespace lacuna::synth
