// The true loops of a synthetic surface, from grid nodes to the ids of the points written.
#pragma once

#include "tools/synth/surface_grid.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace lacuna::synth {

// Holds the loops' nodes only, whatever the size of the surface.
class TruthLoops {
 public:
  explicit TruthLoops(std::vector<NodeLoop> loops);

  // `node` is on a loop and was written as the `id`-th point.
  void note(std::uint64_t node, std::uint64_t id);

  // Once every node is noted: the loops as ids, each from its smallest towards that one's smaller neighbour,
  // sorted.
  std::vector<std::vector<std::uint64_t>> in_ids() const;

 private:
  std::size_t place(std::uint64_t node) const;

  std::vector<NodeLoop> loops_;
  std::vector<std::uint64_t> nodes_;  // of all loops, ascending
  std::vector<std::uint64_t> ids_;    // of nodes_
};

}  // namespace lacuna::synth
