// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/tangential_boundary.hpp"

#include "engine/boundary/tangential/curves.hpp"
#include "engine/boundary/tangential/emit_stars.hpp"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

namespace lacuna::tangential {
namespace {

// Measured for a wedge of a tile, its partners and its curve.
constexpr std::uint64_t kBytesPerWedge = 240;

// The bytes of an open chain of a component, its ends and their partners.
constexpr std::uint64_t kBytesPerChain = sizeof(OpenChain) + 64;

// Wedges of one point, which are next to each other, connect the chains that they are on.
void connect_chains(std::span<const Wedge> wedges, std::span<const LocalIndex> chain_of,
                    UnionFind connected) {
  for (std::size_t i = 1; i < wedges.size(); ++i) {
    if (wedges[i].row == wedges[i - 1].row) connected.unite(chain_of[i - 1], chain_of[i]);
  }
}

}  // namespace

TangentialBoundary::TangentialBoundary(const Tiling& tiling, const TangentialConfig& config,
                                       const Spill& spill, const Workers& workers)
    : tiling_(tiling),
      config_(config),
      spill_(spill),
      workers_(workers),
      curve_budget_(workers.memory.work / 8 / workers.arena.threads()),
      chain_points_(spill.file("chain-points")),
      loops_(spill.file("loops")) {}

void TangentialBoundary::emit(const EvaluatedTile& tile, TileOutput& output) const {
  emit_stars(tile, config_, output);
}

void TangentialBoundary::complete_edges(const TileOutputs& outputs) {
  exchange_.emplace(outputs, tiling_, config_, spill_, workers_);
  exchange_->find_active_points();
}

// Adds the loops along a closed curve.
void TangentialBoundary::add_loops(std::span<const CurvePoint> curve, Scale scale, Scratch& scratch) {
  const auto least = static_cast<std::size_t>(config_.min_curve);
  if (curve.size() < least) return;
  split_at_pinches(curve, scratch, [&](std::span<const CurvePoint> simple) {
    if (simple.size() < least) return;
    const LoopEvidence evidence = evidence_of(simple, scale, config_, scratch);
    if (!evidence.may_be_hole()) return;
    loops_.add(simple.size(), evidence, [&](std::uint64_t i) -> LoopPoint {
      scratch.trim(sizeof(CurvePoint));
      return simple[i];
    });
  });
}

// Finds the loops that lie in the tile. The open chains go to the stitch, whose vertices are the chains.
void TangentialBoundary::chain_tile(TileIndex t) {
  const std::vector<Wedge> wedges = exchange_->wedges(t);
  // Each wedge ends at two edges, each edge at two wedges.
  std::atomic_ref(edges_) += static_cast<std::uint64_t>(std::count_if(
      wedges.begin(), wedges.end(), [](const Wedge& wedge) { return wedge.scale == Scale::kFine; }));
  std::vector<LocalIndex> chain_of(wedges.size());
  std::vector<CurvePoint> points;
  TileGraph<OpenChain> part{.single_vertices_count = true};
  follow_wedges(wedges, partners_of(wedges), [&](const WedgeChain& chain) {
    const LocalIndex number = part.vertices++;
    points.clear();
    for (const LocalIndex w : chain.wedges) {
      chain_of[w] = number;
      points.push_back({wedges[w].point, wedges[w].evidence});
    }
    const Scale scale = wedges[chain.wedges.front()].scale;
    if (chain.is_closed) {
      Scratch scratch(spill_.folder, curve_budget_);
      add_loops(points, scale, scratch);
      return;
    }
    const auto end = [&](LocalIndex w, std::size_t side) {
      const ChainEnd end{wedges[w].row, side == 0 ? wedges[w].from : wedges[w].to};
      part.crossings.push_back({number, end.own, end.foreign});
      return end;
    };
    const ChainEnd first = end(chain.wedges.front(), chain.first_side),
                   last = end(chain.wedges.back(), chain.last_side);
    part.records.push_back({chain_points_.append(points), points.size(), scale, {first, last}});
    part.vertex_of.push_back(number);
  });
  std::vector<LocalIndex> links(part.vertices);
  part.links = links;
  connect_chains(wedges, chain_of, UnionFind(links));
  stitch_->add(t, part);
}

void TangentialBoundary::stitch(const TileOutputs&, const Totals&) {
  const std::size_t tiles = tiling_.tiles.size();
  stitch_.emplace(tiles, kBytesPerChain, spill_, workers_);
  std::vector<std::uint64_t> needs(tiles);
  for (TileIndex t = 0; t < tiles; ++t)
    needs[t] = exchange_->growing_bytes(t) + exchange_->most_wedges(t) * kBytesPerWedge;
  const MemoryLedger::Lease curves = workers_.memory.ledger.take(workers_.memory.work / 8);
  workers_.for_each_within(workers_.memory.work - curves.bytes(), needs,
                           [&](std::size_t t) { chain_tile(static_cast<TileIndex>(t)); });
  exchange_.reset();
}

FoundLoops TangentialBoundary::find_loops(const TileOutputs&) {
  const MemoryLedger::Lease curves = workers_.memory.ledger.take(workers_.memory.work / 8);
  const auto add = [&](auto curve, Scale scale, Scratch& scratch) { add_loops(curve, scale, scratch); };
  stitch_->for_each_component(
      [&](std::span<const OpenChain> chains) {
        close_chains(chains, chain_points_, spill_.folder, curve_budget_, add);
      },
      [&](const auto& for_each_chain, std::uint64_t count) {
        const MemoryLedger::Lease lease = workers_.memory.ledger.take(workers_.memory.work / 4 * 3);
        close_many_chains(for_each_chain, count, chain_points_, spill_.folder, lease.bytes() / 3, add);
      });
  loops_.sort();
  return {.loops = std::move(loops_), .edges = edges_, .components = stitch_->components()};
}

}  // namespace lacuna::tangential
