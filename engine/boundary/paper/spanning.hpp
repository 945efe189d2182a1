// SPDX-License-Identifier: Apache-2.0
// spanning: the minimum spanning graph that admits long loops only (paper, 5.1).
#pragma once

#include "engine/boundary/paper/path_search.hpp"
#include "engine/model/ids.hpp"
#include "engine/stitch/union_find.hpp"
#include "engine/store/scratch.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::paper {

// Vertices are numbered in any way (near in number, near in memory); list v holds the neighbours of v in
// ascending order of their ids.
struct SpanningGraph {
  std::span<const PointId> ids;            // of each vertex
  std::span<const std::uint64_t> offsets;  // vertices + 1
  std::span<const LocalIndex> indices;

  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
  std::span<const LocalIndex> operator[](LocalIndex v) const {
    return indices.subspan(offsets[v], offsets[v + 1] - offsets[v]);
  }
};

// The graph is built edge by edge, in ascending order of (w_total, lower id, higher id). An edge between two
// trees joins them. An edge within a tree is taken only if the loop that it closes has more than e edges.
// Then no path of fewer than e edges joins its ends so far. The graph lives in `scratch`. Cost: per edge
// within a tree, the vertices within e / 2 steps.
class Spanning {
 public:
  Spanning(std::span<const PointId> ids, std::int64_t e, Scratch& scratch);

  void add(LocalIndex a, LocalIndex b);
  SpanningGraph finish();

 private:
  // A vertex with its first neighbours inlined. Most of the graph is chains and trees, and a search touches
  // half a cache line per vertex.
  struct Node {
    static constexpr std::size_t kInline = 5;
    std::uint32_t mark;  // of the search that reached it last
    std::uint32_t degree;
    std::uint32_t more;  // 1 + number of its newest block of neighbours; 0: it has none
    std::array<LocalIndex, kInline> neighbours;
  };
  // Further neighbours of a vertex.
  struct Block {
    static constexpr std::size_t kSize = 7;
    std::array<LocalIndex, kSize> neighbours;
    std::uint32_t before;  // 1 + number of the vertex's block before; 0: it is the first
  };

  bool connects(LocalIndex a, LocalIndex b);
  void link(LocalIndex from, LocalIndex to);
  Block& block(std::uint32_t number) { return chunks_[number / kChunk][number % kChunk]; }
  std::uint32_t add_block(std::uint32_t before);
  template <class Visit>
  void for_each_neighbour(const Node& node, Visit&& visit);

  static constexpr std::uint32_t kChunk = 1 << 12;

  std::span<const PointId> ids_;
  std::int64_t e_;
  Scratch& scratch_;
  UnionFind trees_;
  std::span<Node> nodes_;
  std::vector<std::span<Block>> chunks_;  // of kChunk blocks, for the few vertices with many edges
  std::uint32_t blocks_ = 0;
  std::uint64_t half_edges_ = 0;
  PathSearch search_;
};

}  // namespace lacuna::paper
