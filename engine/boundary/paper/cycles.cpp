// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/cycles.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace lacuna::paper {
namespace {

// Finds which edges lie on a cycle.
class Cycles {
 public:
  Cycles(const SpanningGraph& graph, Scratch& scratch)
      : graph_(graph),
        scratch_(scratch),
        entered_(scratch.array<LocalIndex>(graph.size())),
        low_(scratch.array<LocalIndex>(graph.size())),
        parent_(scratch.array<LocalIndex>(graph.size())),
        next_(scratch.array<std::uint64_t>(graph.size())) {
    for (LocalIndex root = 0; root < graph.size(); ++root) {
      if (entered_[root] == 0) visit_from(root);
    }
  }

  // The edge lies on a cycle.
  bool keeps(LocalIndex v, LocalIndex w) const { return !is_bridge(v, w) && !is_bridge(w, v); }

 private:
  bool is_bridge(LocalIndex parent, LocalIndex child) const {
    return parent_[child] == parent && low_[child] == entered_[child];
  }

  // Depth first: low = the earliest vertex that the subtree reaches without its parent edge (Tarjan 1974).
  void visit_from(LocalIndex root) {
    LocalIndex v = root;
    parent_[root] = root;
    enter(v);
    for (;;) {
      scratch_.trim();
      if (next_[v] < graph_[v].size()) {
        const LocalIndex w = graph_[v][next_[v]++];
        if (entered_[w] == 0) {
          parent_[w] = v;
          enter(w);
          v = w;
        } else if (w != parent_[v]) {
          low_[v] = std::min(low_[v], entered_[w]);
        }
      } else {
        if (v == root) return;
        const LocalIndex up = parent_[v];
        low_[up] = std::min(low_[up], low_[v]);
        v = up;
      }
    }
  }

  void enter(LocalIndex v) { entered_[v] = low_[v] = ++clock_; }

  const SpanningGraph& graph_;
  Scratch& scratch_;
  std::span<LocalIndex> entered_, low_, parent_;
  std::span<std::uint64_t> next_;
  LocalIndex clock_ = 0;
};

}  // namespace

SpanningGraph keep_cycles(const SpanningGraph& graph, Scratch& scratch) {
  Scratch work(scratch.folder(), scratch.budget() / 2);
  const Cycles cycles(graph, work);
  const auto offsets = scratch.array<std::uint64_t>(std::size_t{graph.size()} + 1);
  const auto indices = scratch.array<LocalIndex>(graph.indices.size());
  std::uint64_t end = 0;
  for (LocalIndex v = 0; v < graph.size(); ++v) {
    scratch.trim();
    for (const LocalIndex w : graph[v]) {
      if (cycles.keeps(v, w)) indices[end++] = w;
    }
    offsets[v + 1] = end;
  }
  return {graph.ids, offsets, indices.first(end)};
}

}  // namespace lacuna::paper
