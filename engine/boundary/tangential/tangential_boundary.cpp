// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/tangential_boundary.hpp"

#include "engine/boundary/tangential/curves.hpp"
#include "engine/boundary/tangential/tile_boundary.hpp"

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
  TileBoundary boundary(tile, config_);
  boundary.emit(output);
  const std::vector<Wedge> wedges = boundary.wedges();
  const WedgeData data{.point = [&](std::uint64_t w) { return boundary.curve_point(wedges[w]); },
                       .surface = [&](std::uint64_t w) { return boundary.surface(wedges[w]); }};
  TileLoops loops;
  const auto add_loops = [&](std::span<const CurveStep> curve, Scale scale) {
    if (curve.size() < static_cast<std::size_t>(config_.min_curve)) return;  // most are: no Scratch for them
    Scratch scratch(spill_.folder, curve_budget_);
    find_loops_along(curve, scale, data, config_, scratch,
                     [&](std::span<const CurveStep> loop, const LoopEvidence& evidence) {
                       loops.loops.push_back({loop.size(), evidence});
                       for (const CurveStep& step : loop)
                         loops.points.push_back(boundary.loop_point(wedges[step.wedge]));
                     });
  };
  follow_curves(wedges, data.point, add_loops).emit(output);
  std::move(loops).emit(output);
}

void TangentialBoundary::complete_edges(const TileOutputs& outputs) {
  exchange_.emplace(outputs, tiling_, config_, spill_, workers_);
  exchange_->find_active_points();
}

// Adds the loops along a closed curve. `points`: of its wedges.
void TangentialBoundary::add_loops(std::span<const CurveStep> curve, Scale scale,
                                   std::span<const CurvePoint> points, Scratch& scratch) {
  const WedgeData data{.point = [&](std::uint64_t w) { return points[w]; },
                       .surface = [&](std::uint64_t w) { return points[w].evidence.surface; }};
  find_loops_along(curve, scale, data, config_, scratch,
                   [&](std::span<const CurveStep> loop, const LoopEvidence& evidence) {
                     loops_.add(loop.size(), evidence, [&](std::uint64_t i) -> LoopPoint {
                       scratch.trim(sizeof(CurvePoint));
                       return points[loop[i].wedge];
                     });
                   });
}

// Adds the loops that the tile has closed.
void TangentialBoundary::add_closed_loops(const TileLoops& closed) {
  std::span<const LoopPoint> left = closed.points;
  for (const auto& [points, evidence] : closed.loops) {
    loops_.add(points, evidence, [&](std::uint64_t i) { return left[i]; });
    left = left.subspan(points);
  }
}

// Passes the open chains of the tile on to the stitch, whose vertices are their components. Wedges of open
// stars are known by now, and form chains, too.
void TangentialBoundary::stitch_tile(const TileOutputs& outputs, TileIndex t) {
  add_closed_loops(TileLoops::read(outputs, t));
  TileGraph<OpenChain> graph;
  const auto add = [&](OpenChains open) {
    std::atomic_ref(edges_) += open.totals.edges;
    std::atomic_ref(closed_components_) += open.totals.components;
    const std::uint64_t first = chain_points_.append(open.points);
    const LocalIndex before = graph.vertices;
    for (std::size_t c = 0; c < open.chains.size(); ++c) {
      OpenChain& chain = open.chains[c];
      chain.first += first;
      const LocalIndex vertex = before + open.components[c];
      graph.vertices = std::max(graph.vertices, vertex + 1);
      for (const ChainEnd& end : chain.ends) graph.crossings.push_back({vertex, end.own, end.foreign});
      graph.records.push_back(chain);
      graph.vertex_of.push_back(vertex);
    }
  };
  add(OpenChains::read(outputs, t));
  const OpenWedges open = exchange_->wedges(t);
  add(follow_curves(
      open.wedges, [&](std::uint64_t w) { return open.points[w]; },
      [&](std::span<const CurveStep> curve, Scale scale) {
        Scratch scratch(spill_.folder, curve_budget_);
        add_loops(curve, scale, open.points, scratch);
      }));
  std::vector<LocalIndex> links(graph.vertices);
  graph.links = links;
  stitch_->add(t, graph);
}

void TangentialBoundary::stitch(const TileOutputs& outputs, const Totals&) {
  const std::size_t tiles = tiling_.tiles.size();
  stitch_.emplace(tiles, kBytesPerChain, spill_, workers_);
  std::vector<std::uint64_t> needs(tiles);
  for (TileIndex t = 0; t < tiles; ++t)
    needs[t] = exchange_->growing_bytes(t) + exchange_->most_wedges(t) * kBytesPerWedge +
               TileLoops::bytes(outputs, t) + 2 * OpenChains::bytes(outputs, t);
  const MemoryLedger::Lease curves = workers_.memory.ledger.take(workers_.memory.work / 8);
  workers_.for_each_within(workers_.memory.work - curves.bytes(), needs,
                           [&](std::size_t t) { stitch_tile(outputs, static_cast<TileIndex>(t)); });
  exchange_.reset();
}

FoundLoops TangentialBoundary::find_loops(const TileOutputs&) {
  const MemoryLedger::Lease curves = workers_.memory.ledger.take(workers_.memory.work / 8);
  const auto add = [&](std::span<const CurvePoint> points, Scale scale, Scratch& scratch) {
    const std::span<CurveStep> curve = scratch.array<CurveStep>(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      scratch.trim(sizeof(CurvePoint));
      curve[i] = {points[i].id, i};
    }
    add_loops(curve, scale, points, scratch);
  };
  stitch_->for_each_component([&](const auto& for_each_chain, std::uint64_t count, std::uint64_t memory) {
    Scratch scratch(spill_.folder, memory / 2);
    close_chains(for_each_chain, count, chain_points_, curve_budget_, scratch, add);
  });
  loops_.sort();
  return {
      .loops = std::move(loops_), .edges = edges_, .components = closed_components_ + stitch_->components()};
}

}  // namespace lacuna::tangential
