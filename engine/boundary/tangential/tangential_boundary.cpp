// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/tangential_boundary.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <utility>

namespace lacuna::tangential {

// ---- One tile

namespace {

// Returns the seeds, ascending.
std::vector<LocalIndex> seeds_of(const EvaluatedTile& tile, double seed_probability) {
  std::vector<LocalIndex> seeds;
  std::copy_if(tile.candidates.begin(), tile.candidates.end(), std::back_inserter(seeds),
               [&](LocalIndex p) { return tile.evaluations[p].probability > seed_probability; });
  return seeds;
}

// Returns whether other tiles may change which triangles of a measured star are consistent.
bool is_open(PointState state, std::span<const Consistency> consistencies) {
  return state == PointState::kMaybeActive ||
         std::ranges::any_of(consistencies, [](const Consistency& c) { return c.is_undecided; });
}

}  // namespace

TileBoundary::TileBoundary(const EvaluatedTile& tile, const TangentialConfig& config)
    : tile_(tile),
      config_(config),
      found_(find_stars(tile.points, tile.neighbourhoods, tile.evaluations,
                        seeds_of(tile, config.seed_probability), tile.is_border, config)),
      place_(tile.points.owned, kNoIndex) {}

std::vector<Wedge> TileBoundary::wedges() const {
  std::vector<Wedge> wedges;
  for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
    const auto consistencies = found_.stars.consistencies_of(p);
    if (!is_measured(found_.states[p]) || is_open(found_.states[p], consistencies)) continue;
    add_wedges(
        tile_.points.ids[p], tile_.points.rows[p], found_.stars[p], consistencies,
        [&](LocalIndex q) { return tile_.points.rows[q]; }, wedges);
  }
  return wedges;
}

CurvePoint TileBoundary::curve_point(const Wedge& wedge) {
  const LocalIndex p = tile_.tile.local(wedge.row);
  const double distance = found_.samplings[p].distance;
  const double sampling_radius = sampling_radii(p)[static_cast<std::size_t>(wedge.scale)];
  return {loop_point(wedge),
          {.length = (length(p, tile_.tile.local(wedge.from)) + length(p, tile_.tile.local(wedge.to))) / 2,
           .sampling_radius = sampling_radius,
           .distance = distance,
           .clearness = clearness(wedge.radius * distance, sampling_radius, config_),
           .surface = surface(p)}};
}

LoopPoint TileBoundary::loop_point(const Wedge& wedge) const {
  return loop_point_of(tile_, tile_.tile.local(wedge.row));
}

float TileBoundary::surface(const Wedge& wedge) const {
  return surface(tile_.tile.local(wedge.row));
}

float TileBoundary::surface(LocalIndex p) const {
  return surface_around(tile_.neighbourhoods[p],
                        [&](LocalIndex q) { return tile_.evaluations[q].surface_share; });
}

const RadiiAround& TileBoundary::around(LocalIndex p) {
  around_.gather(p, tile_.neighbourhoods[p], [&](LocalIndex q) {
    return ScaledRadii{radii(q), found_.samplings[q].distance};
  });
  return around_;
}

const TileBoundary::SamplingRadii& TileBoundary::sampling_radii(LocalIndex p) {
  if (place_[p] == kNoIndex) {
    place_[p] = static_cast<LocalIndex>(sampling_radii_.size());
    const RadiusBound& bound = found_.stars.places[p].bound;
    const double distance = found_.samplings[p].distance;
    const RadiiAround& radii = around(p);
    sampling_radii_.push_back(
        {radii.sampling_radius(bound.fine * distance), radii.sampling_radius(bound.coarse * distance)});
  }
  return sampling_radii_[place_[p]];
}

double TileBoundary::length(LocalIndex p, LocalIndex q) const {
  return std::sqrt(squared_distance(tile_.points.positions[q], tile_.points.positions[p]));
}

namespace {

// Marks the owned points for which is_wanted(p) is true, and all of their neighbours.
template <class Wanted>
std::vector<std::uint8_t> with_neighbours(const EvaluatedTile& tile, Wanted&& is_wanted) {
  std::vector<std::uint8_t> marks(tile.points.size());
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (!is_wanted(p)) continue;
    marks[p] = 1;
    for (const LocalIndex q : tile.neighbourhoods[p]) marks[q] = 1;
  }
  return marks;
}

}  // namespace

void TileBoundary::emit(TileOutput& output) {
  std::vector<LocalIndex> active;
  for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
    if (found_.is_active[p]) active.push_back(p);
  }
  output.add(kActive, std::move(active));
  emit_open_stars(output);
  emit_belt(output);
}

void TileBoundary::emit_open_stars(TileOutput& output) {
  OpenStars open;
  for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
    const auto consistencies = found_.stars.consistencies_of(p);
    if (!is_measured(found_.states[p]) || !is_open(found_.states[p], consistencies)) continue;
    open.add(
        loop_point_of(tile_, p), p, found_.stars[p], found_.samplings[p].distance, around(p), surface(p),
        [&](LocalIndex q) { return std::pair(tile_.points.rows[q], length(p, q)); },
        [&](std::size_t i) { return consistencies[i]; });
  }
  output.add(kOpenStars, std::move(open.stars));
  output.add(kOpenVertices, std::move(open.vertices));
}

// Emits the belt, and the sites and samplings that its stars need, here and in other tiles.
void TileBoundary::emit_belt(TileOutput& output) const {
  const auto is_around = with_neighbours(tile_, [&](LocalIndex p) { return is_in_belt(found_.states[p]); });
  std::vector<LocalIndex> around;
  for (LocalIndex p = 0; p < tile_.points.size(); ++p) {
    if (is_around[p]) around.push_back(p);
  }
  // Rows ascend among the owned points, and among the foreign ones.
  std::inplace_merge(around.begin(), std::lower_bound(around.begin(), around.end(), tile_.points.owned),
                     around.end(),
                     [&](LocalIndex a, LocalIndex b) { return tile_.points.rows[a] < tile_.points.rows[b]; });
  std::vector<LocalIndex> place(tile_.points.size());
  std::vector<Row> rows;
  for (const LocalIndex p : around) {
    place[p] = static_cast<LocalIndex>(rows.size());
    rows.push_back(tile_.points.rows[p]);
  }

  std::vector<BeltPoint> belt;
  std::vector<LocalIndex> neighbours;
  for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
    if (!is_in_belt(found_.states[p])) continue;
    const Eigen::Vector3d& normal = tile_.evaluations[p].normal;
    belt.push_back({.point = loop_point_of(tile_, p),
                    .owned = p,
                    .place = place[p],
                    .neighbours = static_cast<std::uint32_t>(tile_.neighbourhoods[p].size()),
                    .normal = {normal.x(), normal.y(), normal.z()},
                    .is_border = found_.states[p] == PointState::kBorder});
    for (const LocalIndex q : tile_.neighbourhoods[p]) neighbours.push_back(place[q]);
  }
  output.add(kBelt, std::move(belt));
  output.add(kBeltRows, std::move(rows));
  output.add(kBeltNeighbours, std::move(neighbours));

  std::vector<LocalIndex> owned;
  std::vector<Site> sites;
  std::vector<StarSample> samples;
  for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
    if (!is_around[p]) continue;
    owned.push_back(p);
    sites.push_back(site_of(tile_.points.positions[p], tile_.evaluations[p]));
    samples.push_back({found_.samplings[p], radii(p), tile_.evaluations[p].surface_share});
  }
  output.add(kSampled, std::move(owned));
  output.add(kSites, std::move(sites));
  output.add(kSamples, std::move(samples));
}

// ---- All tiles

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
