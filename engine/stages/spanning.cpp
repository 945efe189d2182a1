#include "engine/stages/spanning.hpp"

#include <algorithm>

#include "engine/stages/union_find.hpp"

namespace lacuna {
namespace {

// The graph while it grows: half edges in lists, newest first.
class GrowingGraph {
 public:
  static constexpr std::uint64_t kEnd = 0;

  GrowingGraph(LocalIndex vertices, std::uint64_t edge_count, Scratch& scratch)
      : first_(scratch.array<std::uint64_t>(vertices)),
        next_(scratch.array<std::uint64_t>(2 * edge_count + 1)),
        to_(scratch.array<LocalIndex>(2 * edge_count + 1)) {}

  void insert(LocalEdge edge) {
    link(edge.a, edge.b);
    link(edge.b, edge.a);
  }

  template <class Visit>
  void for_each_neighbour(LocalIndex v, Visit&& visit) const {
    for (std::uint64_t half = first_[v]; half != kEnd; half = next_[half]) visit(to_[half]);
  }

  std::uint64_t half_edges() const { return used_; }

 private:
  void link(LocalIndex from, LocalIndex to) {
    const std::uint64_t half = ++used_;
    to_[half] = to;
    next_[half] = first_[from];
    first_[from] = half;
  }

  std::span<std::uint64_t> first_, next_;
  std::span<LocalIndex> to_;
  std::uint64_t used_ = 0;
};

// Is there a path of at most `limit` edges? Two balls grow towards each other, the smaller front first.
class PathSearch {
 public:
  PathSearch(const GrowingGraph& graph, LocalIndex vertices, Scratch& scratch)
      : graph_(graph), scratch_(scratch), mark_(scratch.array<std::uint64_t>(vertices)) {}

  bool connects(LocalIndex a, LocalIndex b, std::int64_t limit) {
    stamp_ += 2;
    std::uint64_t here = stamp_, there = stamp_ + 1;
    near_.assign(1, a);
    far_.assign(1, b);
    mark_[a] = here;
    mark_[b] = there;
    for (std::int64_t length = 0; length < limit && !near_.empty() && !far_.empty(); ++length) {
      if (near_.size() > far_.size()) {
        near_.swap(far_);
        std::swap(here, there);
      }
      if (advance(here, there)) return true;
    }
    return false;
  }

 private:
  // One step of the near front; true if it meets the far ball.
  bool advance(std::uint64_t here, std::uint64_t there) {
    bool met = false;
    next_.clear();
    for (const LocalIndex v : near_) {
      scratch_.breathe();
      graph_.for_each_neighbour(v, [&](LocalIndex w) {
        if (mark_[w] == there) met = true;
        if (mark_[w] >= stamp_) return;
        mark_[w] = here;
        next_.push_back(w);
      });
      if (met) return true;
    }
    near_.swap(next_);
    return false;
  }

  const GrowingGraph& graph_;
  Scratch& scratch_;
  std::span<std::uint64_t> mark_;
  std::uint64_t stamp_ = 0;
  std::vector<LocalIndex> near_, far_, next_;
};

}  // namespace

struct Spanning::State {
  State(LocalIndex vertices, std::uint64_t max_edges, std::int64_t e, Scratch& scratch)
      : vertices(vertices),
        e(e),
        trees(scratch.array<LocalIndex>(vertices)),
        graph(vertices, max_edges, scratch),
        paths(graph, vertices, scratch) {}

  LocalIndex vertices;
  std::int64_t e;
  UnionFind trees;
  GrowingGraph graph;
  PathSearch paths;
};

Spanning::Spanning(LocalIndex vertices, std::uint64_t max_edges, std::int64_t e, Scratch& scratch)
    : scratch_(scratch), state_(std::make_unique<State>(vertices, max_edges, e, scratch)) {}

Spanning::~Spanning() = default;

void Spanning::add(LocalEdge edge) {
  scratch_.breathe();
  const bool joins = state_->trees.unite(edge.a, edge.b);
  if (joins || !state_->paths.connects(edge.a, edge.b, state_->e - 1)) state_->graph.insert(edge);
}

SpanningGraph Spanning::finish() const {
  const GrowingGraph& graph = state_->graph;
  const auto offsets = scratch_.array<std::uint64_t>(std::size_t{state_->vertices} + 1);
  const auto indices = scratch_.array<LocalIndex>(graph.half_edges());
  std::uint64_t end = 0;
  for (LocalIndex v = 0; v < state_->vertices; ++v) {
    scratch_.breathe();
    const std::uint64_t begin = end;
    graph.for_each_neighbour(v, [&](LocalIndex w) { indices[end++] = w; });
    std::sort(indices.begin() + static_cast<std::ptrdiff_t>(begin), indices.begin() + static_cast<std::ptrdiff_t>(end));
    offsets[v + 1] = end;
  }
  return {offsets, indices};
}

}  // namespace lacuna
