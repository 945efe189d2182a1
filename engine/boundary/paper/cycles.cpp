// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/cycles.hpp"

#include <algorithm>
#include <array>
#include <vector>

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

// Returns the graph with two more vertices, last in number and in every list. They have an edge to each of
// `open` and one to each other. There are two, since an open vertex may have many edges outside: no way out
// is a bridge.
SpanningGraph add_outside(const SpanningGraph& graph, std::span<const LocalIndex> open, Scratch& scratch) {
  const std::size_t known = graph.size();
  const std::array<LocalIndex, 2> outside{graph.size(), graph.size() + 1};
  const auto ids = scratch.array<PointId>(known + 2);
  const auto offsets = scratch.array<std::uint64_t>(known + 3);
  const auto indices = scratch.array<LocalIndex>(graph.indices.size() + 4 * open.size() + 2);
  std::copy(graph.ids.begin(), graph.ids.end(), ids.begin());
  std::fill(ids.begin() + static_cast<std::ptrdiff_t>(known), ids.end(), PointId{UINT64_MAX});
  auto to = indices.begin();
  const auto end_row = [&](std::size_t v) {
    offsets[v + 1] = static_cast<std::uint64_t>(to - indices.begin());
  };
  auto next_open = open.begin();
  for (LocalIndex v = 0; v < known; ++v) {
    to = std::copy(graph[v].begin(), graph[v].end(), to);
    if (next_open != open.end() && *next_open == v) {
      to = std::copy(outside.begin(), outside.end(), to);
      ++next_open;
    }
    end_row(v);
  }
  for (const std::size_t i : {0, 1}) {
    to = std::copy(open.begin(), open.end(), to);
    *to++ = outside[1 - i];
    end_row(known + i);
  }
  return {ids, offsets, indices};
}

void mark_reached(const SpanningGraph& graph, LocalIndex from, std::span<std::uint8_t> reached) {
  std::vector<LocalIndex> stack{from};
  reached[from] = 1;
  while (!stack.empty()) {
    const LocalIndex v = stack.back();
    stack.pop_back();
    for (const LocalIndex w : graph[v]) {
      if (!reached[w]) stack.push_back(w);
      reached[w] = 1;
    }
  }
}

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

PartCycles split_cycles(const SpanningGraph& graph, std::span<const LocalIndex> open, Scratch& scratch) {
  const SpanningGraph cycles = keep_cycles(add_outside(graph, open, scratch), scratch);
  const auto reached = scratch.array<std::uint8_t>(cycles.size());
  mark_reached(cycles, graph.size(), reached);
  const auto offsets = scratch.array<std::uint64_t>(std::size_t{graph.size()} + 1);
  const auto indices = scratch.array<LocalIndex>(cycles.indices.size());
  std::uint64_t end = 0;
  for (LocalIndex v = 0; v < graph.size(); ++v) {
    if (!reached[v]) {
      for (const LocalIndex w : cycles[v]) indices[end++] = w;
    }
    offsets[v + 1] = end;
  }
  return {{graph.ids, offsets, indices.first(end)}, reached.first(graph.size())};
}

}  // namespace lacuna::paper
