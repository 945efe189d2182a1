#include "engine/stages/loops.hpp"

#include <algorithm>
#include <vector>

namespace lacuna {
namespace {

// Vertices on some cycle, and the edges between them: bridges and trees hanging off are left out. A search
// cannot tell the difference: what lies beyond a bridge stays in one branch and joins no two.
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
      scratch_.breathe();
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

SpanningGraph keep_cycles(const SpanningGraph& graph, Scratch& scratch) {
  const Cycles cycles(graph, scratch);
  const auto offsets = scratch.array<std::uint64_t>(std::size_t{graph.size()} + 1);
  const auto indices = scratch.array<LocalIndex>(graph.indices.size());
  std::uint64_t end = 0;
  for (LocalIndex v = 0; v < graph.size(); ++v) {
    scratch.breathe();
    for (const LocalIndex w : graph[v]) {
      if (cycles.keeps(v, w)) indices[end++] = w;
    }
    offsets[v + 1] = end;
  }
  return {graph.ids, offsets, indices.first(end)};
}

class Search {
 public:
  Search(const SpanningGraph& graph, Scratch& scratch)
      : graph_(graph),
        scratch_(scratch),
        seen_(scratch.array<LocalIndex>(graph.size())),
        parent_(scratch.array<LocalIndex>(graph.size())),
        branch_(scratch.array<LocalIndex>(graph.size())),
        queue_(scratch.array<LocalIndex>(graph.size())) {}

  // The loop through the origin; empty where there is none.
  std::span<const LocalIndex> loop_through(LocalIndex origin) {
    ++stamp_;
    loop_.clear();
    std::size_t head = 0, tail = 0;
    seen_[origin] = stamp_;
    queue_[tail++] = origin;
    while (head < tail) {
      scratch_.breathe();
      const LocalIndex v = queue_[head++];
      for (const LocalIndex w : graph_[v]) {
        if (seen_[w] != stamp_) {
          seen_[w] = stamp_;
          parent_[w] = v;
          branch_[w] = v == origin ? w : branch_[v];
          queue_[tail++] = w;
        } else if (v != origin && w != origin && branch_[v] != branch_[w]) {
          trace(origin, v, w);
          return loop_;
        }
      }
    }
    return loop_;
  }

 private:
  // From the origin down to v, then from w back up; turned to the canonical start and direction.
  void trace(LocalIndex origin, LocalIndex v, LocalIndex w) {
    for (LocalIndex at = v; at != origin; at = parent_[at]) loop_.push_back(at);
    loop_.push_back(origin);
    std::reverse(loop_.begin(), loop_.end());
    for (LocalIndex at = w; at != origin; at = parent_[at]) loop_.push_back(at);
    const auto lower_id = [&](LocalIndex a, LocalIndex b) { return graph_.ids[a] < graph_.ids[b]; };
    std::rotate(loop_.begin(), std::min_element(loop_.begin(), loop_.end(), lower_id), loop_.end());
    if (lower_id(loop_.back(), loop_[1])) std::reverse(loop_.begin() + 1, loop_.end());
  }

  const SpanningGraph& graph_;
  Scratch& scratch_;
  std::span<LocalIndex> seen_, parent_, branch_, queue_;
  LocalIndex stamp_ = 0;
  std::vector<LocalIndex> loop_;
};

}  // namespace

void find_loops(const SpanningGraph& graph, Scratch& scratch,
                const std::function<void(std::span<const LocalIndex>)>& report) {
  const SpanningGraph cycles = keep_cycles(graph, scratch);
  if (cycles.indices.empty()) return;
  std::vector<LocalIndex> origins;
  for (LocalIndex v = 0; v < graph.size(); ++v) {
    scratch.breathe();
    if (!cycles[v].empty()) origins.push_back(v);
  }
  std::sort(origins.begin(), origins.end(),
            [&](LocalIndex a, LocalIndex b) { return graph.ids[a] < graph.ids[b]; });
  Search search(cycles, scratch);
  const auto on_loop = scratch.array<std::uint8_t>(graph.size());
  for (const LocalIndex origin : origins) {
    if (on_loop[origin]) continue;
    const std::span<const LocalIndex> loop = search.loop_through(origin);
    for (const LocalIndex v : loop) on_loop[v] = 1;
    if (!loop.empty()) report(loop);
  }
}

}  // namespace lacuna
