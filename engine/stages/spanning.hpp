// spanning: the minimum spanning graph that admits long loops only (paper, 5.1).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/core/scratch.hpp"
#include "engine/data/component.hpp"

namespace lacuna {

// Vertices are numbered in ascending order of their ids; row v lists its neighbours in ascending order.
struct SpanningGraph {
  std::span<const std::uint64_t> offsets;  // vertices + 1
  std::span<const LocalIndex> indices;

  LocalIndex size() const { return static_cast<LocalIndex>(offsets.size() - 1); }
  std::span<const LocalIndex> operator[](LocalIndex v) const {
    return indices.subspan(offsets[v], offsets[v + 1] - offsets[v]);
  }
};

// Built edge by edge, in ascending order of (w_total, lower id, higher id), `max_edges` at most. An edge
// between two trees joins them; one within a tree is taken only if the loop that it closes has more than e
// edges: no path of fewer than e edges between its ends so far. The graph lives in `scratch`. Cost: per edge
// within a tree, the points within e / 2 steps.
class Spanning {
 public:
  Spanning(LocalIndex vertices, std::uint64_t max_edges, std::int64_t e, Scratch& scratch);
  ~Spanning();

  void add(LocalEdge edge);
  SpanningGraph finish() const;

 private:
  struct State;
  Scratch& scratch_;
  std::unique_ptr<State> state_;
};

}  // namespace lacuna
