// SPDX-License-Identifier: Apache-2.0
// spanning: the minimum spanning graph that admits long loops only (paper, 5.1).
#pragma once

#include "engine/boundary/paper/path_search.hpp"
#include "engine/model/boundary_graph.hpp"
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

enum class EdgeDecision : std::uint8_t { taken, left_out, undecided };

// The graph is built edge by edge, in ascending order of (w_total, lower id, higher id). An edge between two
// trees joins them. An edge within a tree is taken only if the loop that it closes has more than e edges.
// Then no path of fewer than e edges joins its ends so far. The graph lives in `scratch`. Cost: per edge
// within a tree, the vertices within e / 2 steps.
//
// `open`: vertices at which edges may be missing, since others know them. A decision is then made only if it
// holds whatever is missing. An edge is left out for good, since more edges only make paths shorter. It is
// taken if no path by way of open vertices or undecided edges can be short enough. An undecided edge is not
// in the graph.
class Spanning {
 public:
  Spanning(std::span<const PointId> ids, std::int64_t e, Scratch& scratch,
           std::span<const LocalIndex> open = {});

  EdgeDecision add(LocalEdge edge);
  // Returns whether an edge may be missing at v, or is undecided.
  bool is_open(LocalIndex v) const;
  SpanningGraph finish();

 private:
  // A vertex with its first neighbours inlined. Most of the graph is chains and trees, and a search touches
  // half a cache line per vertex.
  struct Node {
    static constexpr std::size_t kInline = 5;
    std::uint32_t mark;  // of the search that reached it last
    std::uint32_t degree;
    std::uint32_t more;  // 1 + place of further neighbours; 0: no further ones
    std::array<LocalIndex, kInline> neighbours;
  };
  struct MoreNeighbours {
    std::array<LocalIndex, 7> neighbours;
    std::uint32_t next;  // 1 + place; 0: the last
  };

  bool connects(LocalIndex a, LocalIndex b, std::int64_t limit);
  void link(LocalIndex from, LocalIndex to);
  bool may_connect_outside(LocalIndex a, LocalIndex b) const;
  void approach(LocalIndex v, std::int64_t nearness);
  template <class Visit>
  void for_each_neighbour(const Node& node, Visit&& visit) const;

  std::span<const PointId> ids_;
  std::int64_t e_;
  Scratch& scratch_;
  UnionFind trees_;
  std::span<Node> nodes_;
  std::vector<MoreNeighbours> more_;  // of the few vertices with many edges
  std::uint64_t half_edges_ = 0;
  PathSearch search_;
  std::vector<LocalIndex> approached_;
  // By vertex, in half steps: how far its distance to the unknown part is below `horizon_`. Empty: all is
  // known.
  std::span<std::uint32_t> nearness_;
  std::int64_t horizon_;
};

}  // namespace lacuna::paper
