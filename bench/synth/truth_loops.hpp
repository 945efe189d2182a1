// SPDX-License-Identifier: Apache-2.0
// The true loops of a synthetic surface. Numbers of points become ids of the points written.
#pragma once

#include "bench/synth/surface_grid.hpp"

#include <cstdint>
#include <vector>

namespace lacuna::synth {

// Holds the loops' points only, whatever the size of the surface.
class TruthLoops {
 public:
  struct IdLoop {
    std::vector<std::uint64_t> ids;
    bool is_hole;  // else an outer edge
  };

  // The first `holes` loops are the edges of holes, the others outer edges.
  TruthLoops(std::vector<NumberLoop> loops, std::size_t holes);

  // Records that the point of this number was written as the `id`-th. Points that are on no loop are ignored.
  void note(std::uint64_t number, std::uint64_t id);

  // Call it after every point is recorded. Returns the loops as ids, each from its smallest id towards the
  // smaller neighbour of this id, sorted.
  std::vector<IdLoop> in_ids() const;

 private:
  std::vector<NumberLoop> loops_;
  std::size_t holes_;
  std::vector<std::uint64_t> numbers_;  // of all loops, ascending, each once
  std::vector<std::uint64_t> ids_;      // of numbers_
};

}  // namespace lacuna::synth
