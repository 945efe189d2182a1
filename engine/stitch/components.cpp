// SPDX-License-Identifier: Apache-2.0
#include "engine/stitch/components.hpp"

#include "engine/run/error.hpp"

#include <algorithm>

namespace lacuna {
namespace {

// Counts the components that no crossing edge leaves.
std::uint64_t count_closed(UnionFind& connected, LocalIndex vertices,
                           std::span<const LocalIndex> piece_of_root) {
  std::vector<std::uint8_t> is_component(vertices);
  for (LocalIndex v = 0; v < vertices; ++v) {
    const LocalIndex root = connected.find(v);
    if (root != v && piece_of_root[root] == kNoIndex) is_component[root] = 1;
  }
  return static_cast<std::uint64_t>(std::count(is_component.begin(), is_component.end(), 1));
}

}  // namespace

Components::Components(std::size_t tiles, const Spill& spill)
    : tiles_(tiles),
      pieces_(spill, "open-pieces", tiles),
      ends_(spill, "crossing-ends", tiles),
      joins_(spill, "joins", tiles) {}

OpenPieces Components::open_pieces(TileIndex tile, UnionFind& connected, LocalIndex vertices,
                                   std::span<const CrossingEdge> crossings) {
  OpenPieces open{.piece_of_root = std::vector<LocalIndex>(vertices, kNoIndex)};
  std::vector<Join> joins;
  std::vector<Row> ends;
  for (const CrossingEdge& crossing : crossings) {
    LocalIndex& piece = open.piece_of_root[connected.find(crossing.vertex)];
    if (piece == kNoIndex) {
      piece = static_cast<LocalIndex>(open.pieces.size());
      open.pieces.push_back({crossing.own, 0});
    }
    joins.push_back({open.pieces[piece].name, crossing.own});
    if (crossing.own < crossing.foreign) joins.push_back({crossing.own, crossing.foreign});  // once of two
    ends.push_back(crossing.own);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  ends_.append(tile, ends);
  joins_.append(tile, joins);
  count_ += count_closed(connected, vertices, open.piece_of_root);
  return open;
}

// Tiles are in the order of rows.
std::span<Row> Components::sorted_ends(Scratch& scratch) const {
  std::uint64_t count = 0;
  for (std::size_t t = 0; t < tiles_; ++t) count += ends_.count(t);
  const std::span<Row> ends = scratch.array<Row>(count);
  auto end = ends.begin();
  for (std::size_t t = 0; t < tiles_; ++t) {
    const std::vector<Row> of_tile = ends_.read(t);
    end = std::copy(of_tile.begin(), of_tile.end(), end);
    scratch.trim();
  }
  return ends;
}

Components::Batches Components::join(std::uint64_t most_records, Scratch& scratch) {
  const std::span<const Row> ends = sorted_ends(scratch);
  const auto index_of = [&](Row row) {
    scratch.trim();
    const auto at = std::lower_bound(ends.begin(), ends.end(), row);
    if (at == ends.end() || *at != row)
      fail_inconsistent("an edge between two tiles is known to one of them");
    return static_cast<LocalIndex>(at - ends.begin());
  };
  UnionFind components(scratch.array<LocalIndex>(ends.size()));
  for (std::size_t t = 0; t < tiles_; ++t)
    joins_.for_each(t, [&](const Join& join) { components.unite(index_of(join.a), index_of(join.b)); });

  Batches batches;
  const std::span<std::uint64_t> records = scratch.array<std::uint64_t>(ends.size());  // by component
  std::uint64_t pieces = 0;
  for (std::size_t t = 0; t < tiles_; ++t) pieces += pieces_.count(t);
  const std::span<LocalIndex> component_of = scratch.array<LocalIndex>(pieces);
  pieces = 0;
  for (std::size_t t = 0; t < tiles_; ++t) {
    batches.first_piece.push_back(pieces);
    pieces_.for_each(t, [&](const OpenPiece& piece) {
      const LocalIndex component = components.find(index_of(piece.name));
      records[component] += piece.records;
      component_of[pieces++] = component;
    });
  }

  const std::span<std::uint32_t> batch_of = scratch.array<std::uint32_t>(ends.size());
  for (LocalIndex c = 0; c < ends.size(); ++c) {
    scratch.trim();
    count_ += components.find(c) == c;
    if (records[c] == 0) continue;
    if (batches.records.empty() || batches.records.back() + records[c] > most_records)
      batches.records.push_back(0);
    batches.records.back() += records[c];
    batch_of[c] = static_cast<std::uint32_t>(batches.records.size() - 1);
  }
  batches.batch_of = batch_of;
  batches.component_of = component_of;
  return batches;
}

}  // namespace lacuna
