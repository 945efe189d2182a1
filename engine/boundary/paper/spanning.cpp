// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/spanning.hpp"

#include <algorithm>
#include <tuple>

namespace lacuna::paper {
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

}  // namespace lacuna::paper
