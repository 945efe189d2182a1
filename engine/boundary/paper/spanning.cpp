// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/spanning.hpp"

#include "engine/evaluate/evaluate.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace lacuna::paper {
namespace {

// Weights are whole steps, so they can be sorted digit by digit. Most are below 3: three digits.
constexpr int kDigitBits = 9;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

std::uint64_t steps(const WeightedEdge& edge) {
  return static_cast<std::uint64_t>(edge.weight * (1 / kProbabilityStep));
}

// Sorts ascending by one digit of the weight; equal weights keep their order.
void sort_by_digit(std::span<const WeightedEdge> from, std::span<WeightedEdge> to, int shift) {
  const auto digit = [&](const WeightedEdge& edge) { return steps(edge) >> shift & (kDigits - 1); };
  std::array<std::size_t, kDigits> next{};
  for (const WeightedEdge& edge : from) ++next[digit(edge)];
  std::size_t begin = 0;
  for (std::size_t& place : next) begin += std::exchange(place, begin);
  for (const WeightedEdge& edge : from) to[next[digit(edge)]++] = edge;
}

}  // namespace

void order_edges(std::vector<WeightedEdge>& edges, std::span<const PointId> ids) {
  std::uint64_t most = 0;
  for (const WeightedEdge& edge : edges) most = std::max(most, steps(edge));
  std::vector<WeightedEdge> other(edges.size());
  for (int shift = 0; most >> shift != 0; shift += kDigitBits) {
    sort_by_digit(edges, other, shift);
    edges.swap(other);
  }
  const auto by_ids = [&](const WeightedEdge& x, const WeightedEdge& y) {
    return std::minmax(ids[x.a], ids[x.b]) < std::minmax(ids[y.a], ids[y.b]);
  };
  for (auto begin = edges.begin(), end = begin; begin != edges.end(); begin = end) {
    while (end != edges.end() && end->weight == begin->weight) ++end;
    if (end - begin > 1) std::sort(begin, end, by_ids);
  }
}

// ---- One graph, edge by edge

namespace {

// Half steps from an open vertex, or from the end of an undecided edge, to the middle of the unknown. Two
// such vertices may be one edge apart.
constexpr std::int64_t kToUnknown = 1;

}  // namespace

// Two distinct edges close no loop of 2: e = 1 is as good as e = 2, and leaves a margin for half steps.
Spanning::Spanning(std::span<const PointId> ids, std::int64_t e, Scratch& scratch,
                   std::span<const LocalIndex> open)
    : ids_(ids),
      e_(std::max<std::int64_t>(e, 2)),
      scratch_(scratch),
      trees_(scratch.array<LocalIndex>(ids.size())),
      nodes_(scratch.array<Node>(ids.size())),
      nearness_(scratch.array<std::uint32_t>(open.empty() ? 0 : ids.size())),
      horizon_(2 * (e_ - 1)) {
  static_assert(sizeof(Node) == 32 && sizeof(MoreNeighbours) == 32);
  for (const LocalIndex v : open) approach(v, horizon_ - kToUnknown);
}

EdgeDecision Spanning::add(LocalEdge edge) {
  scratch_.trim();
  const auto [a, b] = edge;
  if (trees_.find(a) == trees_.find(b) && connects(a, b, e_ - 1)) return EdgeDecision::left_out;
  if (may_connect_outside(a, b)) {
    approach(a, horizon_ - kToUnknown);
    approach(b, horizon_ - kToUnknown);
    return EdgeDecision::undecided;
  }
  trees_.unite(a, b);
  link(a, b);
  link(b, a);
  if (!nearness_.empty()) {
    approach(a, std::int64_t{nearness_[b]} - 2);
    approach(b, std::int64_t{nearness_[a]} - 2);
  }
  return EdgeDecision::taken;
}

// Returns whether a path of fewer than e edges may lead through the unknown part of the graph.
bool Spanning::may_connect_outside(LocalIndex a, LocalIndex b) const {
  return !nearness_.empty() && std::int64_t{nearness_[a]} + nearness_[b] >= horizon_;
}

// Notes that v is at least this near to the unknown part, and raises the nearness of the vertices around v.
void Spanning::approach(LocalIndex v, std::int64_t nearness) {
  const auto raise = [&](LocalIndex w, std::int64_t to) {
    if (to <= nearness_[w]) return;
    nearness_[w] = static_cast<std::uint32_t>(to);
    approached_.push_back(w);
  };
  approached_.clear();
  raise(v, nearness);
  for (std::size_t i = 0; i < approached_.size(); ++i) {
    for_each_neighbour(nodes_[approached_[i]],
                       [&](LocalIndex w) { raise(w, std::int64_t{nearness_[approached_[i]]} - 2); });
  }
}

void Spanning::link(LocalIndex from, LocalIndex to) {
  Node& node = nodes_[from];
  ++half_edges_;
  if (node.degree < Node::kInline) {
    node.neighbours[node.degree++] = to;
    return;
  }
  const std::size_t beyond = node.degree++ - Node::kInline;
  const std::size_t place = beyond % std::tuple_size_v<decltype(MoreNeighbours::neighbours)>;
  if (place == 0) {
    more_.push_back({{}, node.more});
    node.more = static_cast<std::uint32_t>(more_.size());
  }
  more_[node.more - 1].neighbours[place] = to;
}

template <class Visit>
void Spanning::for_each_neighbour(const Node& node, Visit&& visit) const {
  const std::size_t inlined = std::min<std::size_t>(node.degree, Node::kInline);
  for (std::size_t i = 0; i < inlined; ++i) visit(node.neighbours[i]);
  constexpr std::size_t kBlock = std::tuple_size_v<decltype(MoreNeighbours::neighbours)>;
  std::size_t left = node.degree - inlined;
  for (std::uint32_t block = node.more; block != 0; block = more_[block - 1].next) {
    const std::size_t here = (left - 1) % kBlock + 1;  // only the newest block is not full
    for (std::size_t i = 0; i < here; ++i) visit(more_[block - 1].neighbours[i]);
    left -= here;
  }
}

bool Spanning::connects(LocalIndex a, LocalIndex b, std::int64_t limit) {
  return search_.connects(
      a, b, limit, [&](LocalIndex v) -> std::uint32_t& { return nodes_[v].mark; },
      [&](LocalIndex v, auto&& visit) { for_each_neighbour(nodes_[v], visit); });
}

bool Spanning::is_open(LocalIndex v) const {
  return !nearness_.empty() && nearness_[v] + kToUnknown >= horizon_;
}

SpanningGraph Spanning::finish() {
  const auto offsets = scratch_.array<std::uint64_t>(nodes_.size() + 1);
  const auto indices = scratch_.array<LocalIndex>(half_edges_);
  std::uint64_t end = 0;
  for (std::size_t v = 0; v < nodes_.size(); ++v) {
    scratch_.trim();
    const std::uint64_t begin = end;
    for_each_neighbour(nodes_[v], [&](LocalIndex w) { indices[end++] = w; });
    const auto list = indices.subspan(begin, end - begin);
    std::sort(list.begin(), list.end(), [&](LocalIndex a, LocalIndex b) { return ids_[a] < ids_[b]; });
    offsets[v + 1] = end;
  }
  return {ids_, offsets, indices};
}

// ---- Cycles

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

namespace {

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

// ---- In parts

PartialSpanning span_partially(const KnownVertices& vertices, std::vector<WeightedEdge> edges, std::int64_t e,
                               Scratch& scratch) {
  std::vector<LocalIndex> foreign(vertices.size() - vertices.owned);
  std::iota(foreign.begin(), foreign.end(), vertices.owned);
  order_edges(edges, vertices.ids);
  Spanning spanning(vertices.ids, e, scratch, foreign);
  std::vector<WeightedEdge> undecided;
  std::vector<std::uint8_t> is_open(vertices.size());
  std::erase_if(edges, [&](const WeightedEdge& edge) {
    const EdgeDecision decision = spanning.add({edge.a, edge.b});
    if (decision == EdgeDecision::undecided) undecided.push_back(edge);
    // The other part may report it without knowing the path that excludes it: the path is passed on, too.
    if (decision == EdgeDecision::left_out && !vertices.reports(edge)) is_open[edge.a] = 1;
    return decision != EdgeDecision::taken;
  });
  const std::span<LocalIndex> links = scratch.array<LocalIndex>(vertices.size());
  UnionFind connected(links);
  for (const WeightedEdge& edge : edges) connected.unite(edge.a, edge.b);
  for (const WeightedEdge& edge : undecided) connected.unite(edge.a, edge.b);

  std::vector<LocalIndex> open;
  for (LocalIndex v = 0; v < vertices.size(); ++v) {
    if (is_open[v] || spanning.is_open(v)) open.push_back(v);
  }
  const PartCycles cycles = split_cycles(spanning.finish(), open, scratch);
  const auto is_not_wanted = [&](const WeightedEdge& edge) {
    return !cycles.leads_out[edge.a] || !cycles.leads_out[edge.b] || !vertices.reports(edge);
  };
  std::erase_if(edges, is_not_wanted);
  std::erase_if(undecided, is_not_wanted);
  return {cycles.complete, std::move(edges), std::move(undecided), links};
}

namespace {

struct UndecidedEdge {
  double weight;
  PointId low, high;  // ids
  LocalIndex a, b;

  friend bool operator<(const UndecidedEdge& x, const UndecidedEdge& y) {
    return std::tie(x.weight, x.low, x.high) < std::tie(y.weight, y.low, y.high);
  }
};

// All passed edges by vertex, in both directions. Edges that are not in the graph weigh infinitely.
class WholeGraph {
 public:
  WholeGraph(std::span<const PointId> ids, const ForEachPassedEdge& for_each_edge, Scratch& scratch)
      : ids_(ids),
        scratch_(scratch),
        offsets_(scratch.array<std::uint64_t>(ids.size() + 2)),
        marks_(scratch.array<std::uint32_t>(ids.size())) {
    // Counted two places ahead, so that filling moves each offset to where its vertex ends.
    for_each_edge([&](const PassedEdge& edge) {
      scratch_.trim();
      ++offsets_[edge.a + 2];
      ++offsets_[edge.b + 2];
    });
    for (std::size_t v = 2; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
    neighbours_ = scratch.array<LocalIndex>(offsets_.back());
    weights_ = scratch.array<double>(offsets_.back());
    for_each_edge([&](const PassedEdge& edge) {
      scratch_.trim();
      const double weight = edge.is_taken ? edge.weight : kNotTaken;
      for (const auto& [from, to] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
        const std::uint64_t at = offsets_[from + 1]++;
        neighbours_[at] = to;
        weights_[at] = weight;
      }
    });
  }

  // Returns whether edges before this one connect its ends.
  bool connects(const UndecidedEdge& edge, std::int64_t limit) {
    const auto comes_before = [&](LocalIndex v, std::uint64_t at) {
      if (weights_[at] != edge.weight) return weights_[at] < edge.weight;
      return std::minmax(ids_[v], ids_[neighbours_[at]]) < std::minmax(edge.low, edge.high);
    };
    return search_.connects(
        edge.a, edge.b, limit, [&](LocalIndex v) -> std::uint32_t& { return marks_[v]; },
        [&](LocalIndex v, auto&& visit) {
          scratch_.trim();
          for (std::uint64_t at = offsets_[v]; at < offsets_[v + 1]; ++at) {
            if (comes_before(v, at)) visit(neighbours_[at]);
          }
        });
  }

  void take(const UndecidedEdge& edge) {
    weight_of(edge.a, edge.b) = edge.weight;
    weight_of(edge.b, edge.a) = edge.weight;
  }

  // Removes the edges that were not taken.
  SpanningGraph finish() {
    std::uint64_t begin = 0, end = 0;
    for (std::size_t v = 0; v < ids_.size(); ++v) {
      scratch_.trim();
      const std::uint64_t first = end;
      for (; begin < offsets_[v + 1]; ++begin) {
        if (weights_[begin] != kNotTaken) neighbours_[end++] = neighbours_[begin];
      }
      const auto list = neighbours_.subspan(first, end - first);
      std::sort(list.begin(), list.end(), [&](LocalIndex a, LocalIndex b) { return ids_[a] < ids_[b]; });
      offsets_[v + 1] = end;
    }
    return {ids_, offsets_.first(ids_.size() + 1), neighbours_.first(end)};
  }

 private:
  static constexpr double kNotTaken = std::numeric_limits<double>::infinity();

  double& weight_of(LocalIndex from, LocalIndex to) {
    std::uint64_t at = offsets_[from];
    while (neighbours_[at] != to) ++at;
    return weights_[at];
  }

  std::span<const PointId> ids_;
  Scratch& scratch_;
  std::span<std::uint64_t> offsets_;
  std::span<std::uint32_t> marks_;
  std::span<LocalIndex> neighbours_;
  std::span<double> weights_;
  PathSearch search_;
};

}  // namespace

// Two distinct edges close no loop of 2: e = 1 is as good as e = 2.
SpanningGraph span_whole(std::span<const PointId> ids, const ForEachPassedEdge& for_each_edge, std::int64_t e,
                         std::uint64_t sort_budget, Scratch& scratch) {
  WholeGraph graph(ids, for_each_edge, scratch);
  SortedRuns<UndecidedEdge> undecided(scratch.folder() / "undecided-edges", sort_budget);
  for_each_edge([&](const PassedEdge& edge) {
    if (edge.is_taken) return;
    const auto [low, high] = std::minmax({ids[edge.a], ids[edge.b]});
    undecided.add({edge.weight, low, high, edge.a, edge.b});
  });
  const std::int64_t limit = std::max<std::int64_t>(e, 2) - 1;
  undecided.for_each([&](const UndecidedEdge& edge) {
    if (!graph.connects(edge, limit)) graph.take(edge);
  });
  return graph.finish();
}

}  // namespace lacuna::paper
