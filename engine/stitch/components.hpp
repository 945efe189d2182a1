// SPDX-License-Identifier: Apache-2.0
// Components of the boundary graph across tiles. They come from a union-find within each tile, then one
// global union-find over the ends of the edges that cross.
#pragma once

#include "engine/model/ids.hpp"
#include "engine/model/tiling.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/scratch.hpp"

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {

// Disjoint sets over [0, n). Union is by index, so a set's root is its smallest element. The sets are in
// memory of the caller's, one zero per element. Cost: near constant per call (path halving).
class UnionFind {
 public:
  explicit UnionFind(std::span<LocalIndex> links) : links_(links) {}

  LocalIndex find(LocalIndex x) {
    while (!is_root(x)) {
      const LocalIndex up = parent(x);
      if (!is_root(up)) links_[x] = links_[up];
      x = up;
    }
    return x;
  }

  // Returns false if they were one set already.
  bool unite(LocalIndex a, LocalIndex b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (a > b) std::swap(a, b);
    links_[b] = a + 1;
    return true;
  }

 private:
  bool is_root(LocalIndex x) const { return links_[x] == 0; }
  LocalIndex parent(LocalIndex x) const { return links_[x] - 1; }

  std::span<LocalIndex> links_;  // parent + 1; 0: a root, so that memory fresh from the system will do
};

// An edge of the boundary graph that leaves its tile. Both tiles have it.
struct CrossingEdge {
  LocalIndex vertex;  // its own end, among the vertices of the tile's graph
  Row own, foreign;
};

// An open piece: a component of a tile's graph that crossing edges leave. One of its own ends of
// crossing edges names it, a row that no other open piece has.
struct OpenPiece {
  Row name;
  std::uint64_t records;  // of the tile in this piece
};

// The open pieces of one tile, numbered.
struct OpenPieces {
  std::vector<OpenPiece> pieces;
  std::vector<LocalIndex> piece_of_root;  // by root of the tile's union-find; kNoIndex: closed
};

class Components {
 public:
  Components(std::size_t tiles, const Spill& spill);

  // Returns the open pieces of a tile. The caller counts their `records`. `connected`: of all `vertices` of
  // the tile's graph. Counts the closed components with an edge. From any thread, once for
  // each tile.
  OpenPieces open_pieces(TileIndex tile, UnionFind& connected, LocalIndex vertices,
                         std::span<const CrossingEdge> crossings);
  void add(TileIndex tile, const OpenPieces& open) { pieces_.append(tile, open.pieces); }

  // Joins open pieces to components, once all tiles are added. Groups components to batches of at most
  // `most_records` each. A component with more has a batch of its own.
  struct Batches {
    std::vector<std::uint64_t> records;        // of each batch
    std::span<const std::uint32_t> batch_of;   // by component
    std::span<const LocalIndex> component_of;  // by open piece; the open pieces of tile t begin at
                                               // first_piece[t]
    std::vector<std::uint64_t> first_piece;
  };
  Batches join(std::uint64_t most_records, Scratch& scratch);

  // Returns the number of components with an edge. It is final after `join`.
  std::uint64_t count() const { return count_; }

 private:
  struct Join {
    Row a, b;
  };
  std::span<Row> sorted_ends(Scratch& scratch) const;

  std::size_t tiles_;
  AppendLists<OpenPiece> pieces_;
  AppendLists<Row> ends_;    // own ends of crossing edges, ascending, each once
  AppendLists<Join> joins_;  // of ends in one component
  std::atomic<std::uint64_t> count_ = 0;
};

}  // namespace lacuna
