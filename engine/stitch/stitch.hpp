// SPDX-License-Identifier: Apache-2.0
// stitch: the boundary graph across tiles, component by component. Both methods use this one global stage.
//
// A tile adds its own graph. Loops that lie wholly inside are finished in the tile. For open
// components, which leave the tile, the tile passes on records. Records are boundary edges, in whatever form
// the method needs to find loops. They are grouped by component, in batches that fit in memory. A component
// larger than memory is handed out from disk.
#pragma once

#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "engine/stitch/components.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna {

// A tile's part of the boundary graph.
template <class Record>
struct TileGraph {
  LocalIndex vertices = 0;
  std::span<LocalIndex> links;  // of a UnionFind over the vertices: what its edges connect
  std::vector<CrossingEdge> crossings;
  std::vector<Record> records;        // of its open components
  std::vector<LocalIndex> vertex_of;  // of each record, a vertex of its component
};

// `Record`: plain data.
template <class Record>
class Stitch {
 public:
  // `record_bytes`: memory for each record of a component while its loops are searched.
  Stitch(std::size_t tiles, std::uint64_t record_bytes, const Spill& spill, const Workers& workers)
      : tiles_(tiles),
        record_bytes_(record_bytes),
        spill_(spill),
        workers_(workers),
        components_(tiles, spill),
        open_(spill, "open-records", tiles) {}

  // Adds the graph of a tile. From any thread, once for each tile.
  void add(TileIndex tile, const TileGraph<Record>& graph) {
    UnionFind connected(graph.links);
    OpenPieces open = components_.open_pieces(tile, connected, graph.vertices, graph.crossings);
    std::vector<Member> members;
    members.reserve(graph.records.size());
    for (std::size_t i = 0; i < graph.records.size(); ++i) {
      const LocalIndex of_piece = open.piece_of_root[connected.find(graph.vertex_of[i])];
      if (of_piece == kNoIndex) fail_inconsistent("a record of the stitch leaves no tile");
      members.push_back({of_piece, graph.records[i]});
      ++open.pieces[of_piece].records;
    }
    components_.add(tile, open);
    open_.append(tile, members);
  }

  // A component: calls visit(record) for each of its records, in any order and as often as wanted.
  using ForEachRecord = std::function<void(const std::function<void(const Record&)>&)>;
  // Receives a component, the number of its records, and the bytes that its search may take.
  using VisitComponent =
      std::function<void(const ForEachRecord& for_each_record, std::uint64_t count, std::uint64_t memory)>;

  // Goes through the components once all tiles are added. Several components are visited at a time, with as
  // much memory as they take. A component that does not fit in memory is visited alone, from disk.
  void for_each_component(const VisitComponent& visit) {
    const std::uint64_t fits = workers_.memory.work / 2 / record_bytes_;
    const AppendLists<Member> batches =
        make_batches(std::max<std::uint64_t>(fits / workers_.arena.threads(), 1));
    std::vector<std::uint64_t> needs;
    for (std::size_t b = 0; b < batches.lists(); ++b)
      needs.push_back(batches.count(b) > fits ? 0 : batches.count(b) * record_bytes_);
    workers_.for_each_within(workers_.memory.work / 2, needs, [&](std::size_t b) {
      if (batches.count(b) <= fits) visit_batch(batches.read(b), visit);
    });
    for (std::size_t b = 0; b < batches.lists(); ++b) {
      if (batches.count(b) <= fits) continue;
      const MemoryLedger::Lease lease = workers_.memory.ledger.take(workers_.memory.work / 4 * 3);
      visit([&](const auto& add) { batches.for_each(b, [&](const Member& m) { add(m.record); }); },
            batches.count(b), lease.bytes());
    }
  }

  std::uint64_t components() const { return components_.count(); }

 private:
  struct Member {
    std::uint64_t component;  // at first: the open piece of its tile
    Record record;
  };

  // Groups whole components: a batch has at most `most_records` records, save for one component of more.
  AppendLists<Member> make_batches(std::uint64_t most_records) {
    const MemoryLedger::Lease joining = workers_.memory.ledger.take(workers_.memory.work / 3);
    Scratch scratch(spill_.folder, joining.bytes());
    const Components::Batches batches = components_.join(most_records, scratch);
    AppendLists<Member> lists(spill_, "batches", batches.records.size());
    workers_.arena.for_each(tiles_, [&](std::size_t t) { distribute(t, batches, lists); });
    return lists;
  }

  void distribute(std::size_t tile, const Components::Batches& batches, AppendLists<Member>& lists) {
    std::vector<Member> members = open_.read(tile);
    open_.drop(tile);
    for (Member& m : members) m.component = batches.component_of[batches.first_piece[tile] + m.component];
    const auto batch = [&](const Member& m) { return batches.batch_of[m.component]; };
    std::sort(members.begin(), members.end(),
              [&](const Member& x, const Member& y) { return batch(x) < batch(y); });
    for (std::size_t begin = 0, end; begin < members.size(); begin = end) {
      for (end = begin; end < members.size() && batch(members[end]) == batch(members[begin]);) ++end;
      lists.append(batch(members[begin]), std::span(members).subspan(begin, end - begin));
    }
  }

  static void visit_batch(std::vector<Member> members, const VisitComponent& visit) {
    std::sort(members.begin(), members.end(),
              [](const Member& x, const Member& y) { return x.component < y.component; });
    for (std::size_t begin = 0, end; begin < members.size(); begin = end) {
      for (end = begin; end < members.size() && members[end].component == members[begin].component;) ++end;
      const std::span<const Member> component = std::span(members).subspan(begin, end - begin);
      visit(
          [&](const auto& add) {
            for (const Member& m : component) add(m.record);
          },
          component.size(), UINT64_MAX);
    }
  }

  std::size_t tiles_;
  std::uint64_t record_bytes_;
  const Spill& spill_;
  const Workers& workers_;
  Components components_;
  AppendLists<Member> open_;
};

}  // namespace lacuna
