// SPDX-License-Identifier: Apache-2.0
// spanning: the minimum spanning graph that admits long loops only, of one tile and of all (paper, 5.1;
// method.md, B.2).
//
// Idea: a minimum spanning tree has no loops. So the graph also takes an edge within a tree if the loop that
// it closes is long enough to go around a hole. Whether it is depends on paths of fewer than e edges alone.
// So a tile decides most edges by itself, passes on the others, and a search over what all tiles passed on
// decides those.
//
// Source: the paper, 5.1; bridges: Tarjan, A note on finding the bridges of a graph, 1974.
// Cost: a sort of the edges, and for each edge within a tree the vertices within e / 2 steps.
#pragma once

#include "engine/model/boundary_graph.hpp"
#include "engine/model/ids.hpp"
#include "engine/stitch/components.hpp"
#include "engine/store/scratch.hpp"

#include <array>
#include <cassert>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace lacuna::paper {

// Sorts the edges ascending by (weight, lower id, higher id). Weights: multiples of kProbabilityStep, at
// least 0 and at most 1e9. `ids`: the id of each vertex. Cost: linear except for edges of equal weight; as
// much memory again.
void order_edges(std::vector<WeightedEdge>& edges, std::span<const PointId> ids);

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

// Finds whether a path of few edges joins two vertices. Two balls grow towards each other, the smaller front
// first. It keeps its memory for the next search.
class PathSearch {
 public:
  // Returns whether there is a path of at most `limit` edges. `mark_of(v)` is a number of vertex v, by
  // reference. It is 0 before the first search. `for_each_neighbour(v, visit)` calls `visit(w)`. Cost: the
  // vertices within limit / 2 steps.
  template <class MarkOf, class ForEachNeighbour>
  bool connects(LocalIndex a, LocalIndex b, std::int64_t limit, MarkOf&& mark_of,
                ForEachNeighbour&& for_each_neighbour) {
    assert(stamp_ <= std::numeric_limits<std::uint32_t>::max() - 4);
    stamp_ += 2;
    std::uint32_t here = stamp_, there = stamp_ + 1;
    near_.assign(1, a);
    far_.assign(1, b);
    mark_of(a) = here;
    mark_of(b) = there;
    for (std::int64_t length = 0; length < limit && !near_.empty() && !far_.empty(); ++length) {
      if (near_.size() > far_.size()) {
        near_.swap(far_);
        std::swap(here, there);
      }
      // One step of the near front, until it touches the far ball.
      bool touches = false;
      next_.clear();
      for (const LocalIndex v : near_) {
        for_each_neighbour(v, [&](LocalIndex w) {
          std::uint32_t& mark = mark_of(w);
          if (mark == there) touches = true;
          if (mark >= stamp_) return;
          mark = here;
          next_.push_back(w);
        });
        if (touches) return true;
      }
      near_.swap(next_);
    }
    return false;
  }

 private:
  std::uint32_t stamp_ = 0;
  std::vector<LocalIndex> near_, far_, next_;  // fronts
};

// ---- One graph, edge by edge

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

// ---- Cycles: the edges of a spanning graph that can lie on a loop

// Returns the graph without its bridges and the trees that hang off it. The edges that lie on some cycle
// remain, in the same order. A search for loops gives the same result: vertices beyond a bridge stay in one
// branch and join no two branches. Cost: linear.
SpanningGraph keep_cycles(const SpanningGraph& graph, Scratch& scratch);

// The cycles of a graph of which only a part is known. The unknown part may lie on either side of its
// bridges.
struct PartCycles {
  SpanningGraph complete;                   // cycles that do not touch the rest of the graph
  std::span<const std::uint8_t> leads_out;  // by vertex: no bridge cuts it off from the open ones
};

// `open`: vertices that may have more edges than are known here; ascending, each once. A path between
// vertices that lead out passes only such vertices. So does every loop through one of them. Without open
// vertices all cycles are complete. Cost: linear.
PartCycles split_cycles(const SpanningGraph& graph, std::span<const LocalIndex> open, Scratch& scratch);

// ---- In parts: what a tile decides alone, and the graph of the edges that all tiles have passed on

// The owned vertices, then the foreign ones at the other ends of their edges.
struct KnownVertices {
  std::span<const PointId> ids;
  LocalIndex owned;

  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
  // Two tiles have an edge between them; the one that owns the lower id reports it. a: owned.
  bool reports(const WeightedEdge& edge) const { return edge.b < owned || ids[edge.a] < ids[edge.b]; }
};

struct PartialSpanning {
  SpanningGraph complete;  // whose loops are loops of the whole
  // Edges that are passed on, in any order. Taken edges are in the graph for certain, undecided edges may be.
  std::vector<WeightedEdge> taken, undecided;
  std::span<LocalIndex> links;  // links of a UnionFind: vertices that all edges of the tile connect
};

// `edges`: all edges that have an owned end, in any order; a: owned. `span_whole` joins the edges that all
// tiles pass on to one graph. The loops of that graph and the complete ones are all loops of the whole. Most
// edges are certainly left out, and are not passed on. Trees, and cycles beyond a bridge, are not passed on
// either: no loop needs them. Without foreign vertices nothing is passed on. The graph lives in `scratch`.
// The cost is the cost of spanning the tile.
PartialSpanning span_partially(const KnownVertices& vertices, std::vector<WeightedEdge> edges, std::int64_t e,
                               Scratch& scratch);

struct PassedEdge {
  LocalIndex a, b;
  double weight;
  bool is_taken;  // for certain; else undecided
};
// Calls visit(edge) for each edge, in any order, as often as wanted.
using ForEachPassedEdge = std::function<void(const std::function<void(const PassedEdge&)>&)>;

// Taken edges are in the graph. Undecided edges are decided in ascending order of (w_total, lower id, higher
// id), by a search among edges before them. So it is the graph that `Spanning` builds from all edges. `ids`:
// the id of each vertex. Vertices are numbered so that edges of one part lie near each other in memory. The
// graph lives in `scratch`. Cost: linear, and a search for each undecided edge.
SpanningGraph span_whole(std::span<const PointId> ids, const ForEachPassedEdge& for_each_edge, std::int64_t e,
                         std::uint64_t sort_budget, Scratch& scratch);

}  // namespace lacuna::paper
