// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/spanning.hpp"

#include <algorithm>

namespace lacuna::paper {

// Two distinct edges close no loop of 2: e = 1 is as good as e = 2.
Spanning::Spanning(std::span<const PointId> ids, std::int64_t e, Scratch& scratch)
    : ids_(ids),
      e_(std::max<std::int64_t>(e, 2)),
      scratch_(scratch),
      trees_(scratch.array<LocalIndex>(ids.size())),
      nodes_(scratch.array<Node>(ids.size())) {
  static_assert(sizeof(Node) == 32 && sizeof(Block) == 32);
}

void Spanning::add(LocalIndex a, LocalIndex b) {
  scratch_.trim();
  if (!trees_.unite(a, b) && connects(a, b)) return;
  link(a, b);
  link(b, a);
}

// Returns whether a path of fewer than e edges joins the vertices.
bool Spanning::connects(LocalIndex a, LocalIndex b) {
  return search_.connects(
      a, b, e_ - 1, [&](LocalIndex v) -> std::uint32_t& { return nodes_[v].mark; },
      [&](LocalIndex v, auto&& visit) { for_each_neighbour(nodes_[v], visit); });
}

void Spanning::link(LocalIndex from, LocalIndex to) {
  Node& node = nodes_[from];
  ++half_edges_;
  if (node.degree < Node::kInline) {
    node.neighbours[node.degree++] = to;
    return;
  }
  const std::size_t place = (node.degree++ - Node::kInline) % Block::kSize;
  if (place == 0) node.more = add_block(node.more) + 1;
  block(node.more - 1).neighbours[place] = to;
}

std::uint32_t Spanning::add_block(std::uint32_t before) {
  if (blocks_ % kChunk == 0) chunks_.push_back(scratch_.array<Block>(kChunk));
  block(blocks_).before = before;
  return blocks_++;
}

template <class Visit>
void Spanning::for_each_neighbour(const Node& node, Visit&& visit) {
  const std::size_t inlined = std::min<std::size_t>(node.degree, Node::kInline);
  for (std::size_t i = 0; i < inlined; ++i) visit(node.neighbours[i]);
  std::size_t left = node.degree - inlined;
  for (std::uint32_t more = node.more; more != 0; more = block(more - 1).before) {
    const std::size_t here = (left - 1) % Block::kSize + 1;  // only the newest block is not full
    for (std::size_t i = 0; i < here; ++i) visit(block(more - 1).neighbours[i]);
    left -= here;
  }
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
