// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/paper_boundary.hpp"

#include "engine/boundary/paper/spanning.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "engine/store/rows.hpp"
#include "engine/store/scratch.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace lacuna::paper {

// ---- Eligible edges

double eligible_weight(const Strength& a, const Strength& b, double distance, const SpanningConfig& config) {
  constexpr double kNot = -1;
  const double prob_weight = (2 - double{a.probability}) - double{b.probability};
  if (!(prob_weight < config.max_prob_weight)) return kNot;
  const double total = prob_weight + round_to_step(2 * distance / (a.mean_distance + b.mean_distance));
  return total < config.max_total_weight ? total : kNot;
}

bool is_strong(double probability, const SpanningConfig& config) {
  return probability >
         1 - config.max_prob_weight / 2 - kProbabilityStep;  // one step of slack for the halving
}

TileEdges eligible_edges(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                         std::span<const Evaluation> evaluations, const SpanningConfig& config) {
  const auto strength = [&](LocalIndex p) {
    return Strength{evaluations[p].mean_distance, static_cast<float>(evaluations[p].probability)};
  };
  TileEdges edges;
  for (LocalIndex p = 0; p < points.owned; ++p) {
    if (!is_strong(evaluations[p].probability, config)) continue;
    for (const LocalIndex q : neighbourhoods[p]) {
      const double distance = std::sqrt(squared_distance(points.positions[p], points.positions[q]));
      if (!points.is_owned(q)) {
        edges.crossings.push_back({p, q, distance});
        continue;
      }
      const bool sent_by_other =
          is_strong(evaluations[q].probability, config) && points.ids[q] < points.ids[p];
      if (sent_by_other) continue;
      const double weight = eligible_weight(strength(p), strength(q), distance, config);
      if (weight >= 0) edges.inside.push_back({p, q, weight});
    }
  }
  return edges;
}

// ---- The boundary of a tile

namespace {

// What a tile emits.
constexpr RecordStream<LocalIndex> kBorder{"border"};      // points with foreign neighbours, ascending
constexpr RecordStream<Strength> kStrengths{"strengths"};  // of the border points
constexpr RecordStream<TileEdge> kInside{"edges"};         // eligible ones
constexpr RecordStream<UndecidedCrossing> kUndecided{"undecided crossings"};

}  // namespace

PaperBoundary::PaperBoundary(const Tiling& tiling, const SpanningConfig& config, const Spill& spill,
                             const Workers& workers)
    : tiling_(tiling),
      config_(config),
      spill_(spill),
      workers_(workers),
      crossings_(spill, "crossings", tiling.tiles.size()),
      strengths_(spill.file("strengths")),
      loops_(spill.file("raw-loops")) {}

void PaperBoundary::emit(const EvaluatedTile& tile, TileOutput& output) const {
  const auto strength = [&](LocalIndex p) {
    return Strength{tile.evaluations[p].mean_distance, tile.probability(p)};
  };
  std::vector<LocalIndex> border;
  std::vector<Strength> strengths;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (!tile.is_border[p]) continue;
    border.push_back(p);
    strengths.push_back(strength(p));
  }
  output.add(kBorder, std::move(border));
  output.add(kStrengths, std::move(strengths));
  const TileEdges edges = eligible_edges(tile.points, tile.neighbourhoods, tile.evaluations, config_);
  output.add(kInside, edges.inside);
  std::vector<UndecidedCrossing> undecided;
  for (const Crossing& c : edges.crossings)
    undecided.push_back({tile.vertex(c.owned), tile.vertex(c.foreign), strength(c.owned), c.distance});
  output.add(kUndecided, std::move(undecided));

  // These points are ends of eligible edges. Another tile may find edges that cross the border, so all points
  // with foreign neighbours count.
  std::vector<std::uint8_t> is_end(tile.is_border.begin(), tile.is_border.end());
  for (const TileEdge& edge : edges.inside) is_end[edge.a] = is_end[edge.b] = 1;
  std::vector<TileVertex> vertices;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (is_end[p] != 0) vertices.push_back({loop_point_of(tile, p), p});
  }
  output.add(kVertices, std::move(vertices));
}

void PaperBoundary::complete_edges(const TileOutputs& outputs) {
  const std::size_t tiles = tiling_.tiles.size();
  workers_.arena.for_each(tiles, [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    std::vector<Row> rows;
    for (const LocalIndex p : outputs.read(kBorder, t)) rows.push_back(tiling_.tiles[t].row(p));
    write_rows<Strength>(strengths_, rows, outputs.read(kStrengths, t));
  });
  workers_.arena.for_each(tiles,
                          [&](std::size_t t) { decide_crossings(outputs, static_cast<TileIndex>(t)); });
}

void PaperBoundary::decide_crossings(const TileOutputs& outputs, TileIndex t) {
  std::vector<UndecidedCrossing> undecided = outputs.read(kUndecided, t);
  std::sort(undecided.begin(), undecided.end(), [](const auto& a, const auto& b) {
    return a.foreign.row != b.foreign.row ? a.foreign.row < b.foreign.row : a.own.row < b.own.row;
  });
  ColumnReader<Strength> foreign(strengths_);
  std::vector<EligibleCrossing> here;
  for (const UndecidedCrossing& c : undecided) {
    const Strength& other = foreign[value(c.foreign.row)];
    // Both tiles have the edge if both ends are strong: then the tile of the lower id decides.
    if (is_strong(other.probability, config_) && c.foreign.id < c.own.id) continue;
    const double weight = eligible_weight(c.strength, other, c.distance, config_);
    if (weight < 0) continue;
    here.push_back({tiling_.tiles[t].local(c.own.row), c.own, c.foreign, weight});
    const TileIndex there = tiling_.tile_of_row(c.foreign.row);
    crossings_.append(there, {tiling_.tiles[there].local(c.foreign.row), c.foreign, c.own, weight});
  }
  crossings_.append(t, here);
}

// ---- The loops

namespace {

// The vertices that a tile knows. First come its own ends of eligible edges, in ascending row. Then come the
// ends of its crossing edges in other tiles.
class TileVertices {
 public:
  TileVertices(const Tile& tile, std::span<const TileVertex> own, std::span<const EligibleCrossing> crossings)
      : own_(static_cast<LocalIndex>(own.size())), numbers_(tile.points) {
    for (LocalIndex v = 0; v < own_; ++v) {
      numbers_[own[v].owned] = v;
      rows_.push_back(tile.row(own[v].owned));
      ids_.push_back(own[v].id);
    }
    for (const EligibleCrossing& crossing : crossings) foreign_.push_back(crossing.foreign.row);
    std::sort(foreign_.begin(), foreign_.end());
    foreign_.erase(std::unique(foreign_.begin(), foreign_.end()), foreign_.end());
    rows_.insert(rows_.end(), foreign_.begin(), foreign_.end());
    ids_.resize(rows_.size());
    for (const EligibleCrossing& crossing : crossings) ids_[foreign(crossing)] = crossing.foreign.id;
  }

  KnownVertices known() const { return {ids_, own_}; }
  LocalIndex own(LocalIndex point) const { return numbers_[point]; }
  LocalIndex foreign(const EligibleCrossing& crossing) const {
    const auto at = std::lower_bound(foreign_.begin(), foreign_.end(), crossing.foreign.row);
    return own_ + static_cast<LocalIndex>(at - foreign_.begin());
  }
  Vertex operator[](LocalIndex v) const { return {ids_[v], rows_[v]}; }

 private:
  LocalIndex own_;
  std::vector<LocalIndex> numbers_;  // by the tile's points; a point that is no vertex may have any number
  std::vector<Row> rows_, foreign_;
  std::vector<PointId> ids_;
};

// row_of(v): the row of a vertex of the graph.
template <class RowOf>
void find_loops_of(const SpanningGraph& graph, RowOf&& row_of, Scratch& scratch, RawLoops& loops) {
  std::vector<Vertex> loop;
  find_loops(graph, scratch, [&](std::span<const LocalIndex> found) {
    loop.clear();
    for (const LocalIndex v : found) loop.push_back({graph.ids[v], row_of(v)});
    loops.add(loop);
  });
}

}  // namespace

// Finds the loops that do not depend on anything outside of the tile. Edges that may matter elsewhere are
// passed on.
void PaperBoundary::span_tile(const TileOutputs& outputs, TileIndex t) {
  const Tile& tile = tiling_.tiles[t];
  std::vector<WeightedEdge> edges = outputs.read(kInside, t);
  const std::vector<EligibleCrossing> crossings = crossings_.read(t);
  crossings_.drop(t);
  if (edges.empty() && crossings.empty()) return;
  const TileVertices vertices(tile, outputs.read(kVertices, t), crossings);
  for (WeightedEdge& edge : edges) edge = {vertices.own(edge.a), vertices.own(edge.b), edge.weight};
  for (const EligibleCrossing& crossing : crossings)
    edges.push_back({vertices.own(crossing.owned), vertices.foreign(crossing), crossing.weight});
  std::atomic_ref(edges_) += static_cast<std::uint64_t>(std::count_if(
      edges.begin(), edges.end(), [&](const WeightedEdge& edge) { return vertices.known().reports(edge); }));

  Scratch scratch(spill_.folder, workers_.memory.limit);
  const PartialSpanning spanned = span_partially(vertices.known(), std::move(edges), minimum_loop_, scratch);
  find_loops_of(
      spanned.complete, [&](LocalIndex v) { return vertices[v].row; }, scratch, loops_);
  TileGraph<BoundaryEdge> graph{.vertices = vertices.known().size(), .links = spanned.links};
  for (const EligibleCrossing& c : crossings)
    graph.crossings.push_back({vertices.own(c.owned), c.own.row, c.foreign.row});
  const auto pass_on = [&](std::span<const WeightedEdge> some, std::uint64_t is_taken) {
    for (const WeightedEdge& edge : some) {
      graph.records.push_back({edge.weight, vertices[edge.a], vertices[edge.b], is_taken});
      graph.vertex_of.push_back(edge.a);
    }
  };
  pass_on(spanned.taken, 1);
  pass_on(spanned.undecided, 0);
  stitch_->add(t, graph);
}

namespace {

// Measured: edges, vertices and graph of a component while it is spanned.
constexpr std::uint64_t kBytesPerEdge = 120;

// Measured as well, for each vertex of a tile.
constexpr std::uint64_t kBytesPerVertex = 280;

// Returns the steps around the smallest hole that edges of neighbourhoods of K points do not cross.
std::int64_t minimum_loop(const SpanningConfig& config, double mean_neighbours) {
  return config.e > 0 ? config.e : std::llround(2 * std::sqrt(std::numbers::pi * mean_neighbours));
}

}  // namespace

void PaperBoundary::stitch(const TileOutputs& outputs, const Totals& totals) {
  minimum_loop_ = minimum_loop(config_, totals.mean_neighbours());
  stitch_.emplace(tiling_.tiles.size(), kBytesPerEdge, spill_, workers_);
  std::vector<std::uint64_t> needs(tiling_.tiles.size());
  for (TileIndex t = 0; t < needs.size(); ++t) {
    needs[t] = (outputs.count(kInside, t) + crossings_.count(t)) * kBytesPerEdge +
               outputs.count(kVertices, t) * kBytesPerVertex + tiling_.tiles[t].points * sizeof(LocalIndex);
  }
  workers_.for_each_within(workers_.memory.work, needs,
                           [&](std::size_t t) { span_tile(outputs, static_cast<TileIndex>(t)); });
}

namespace {

// Finds the loops of one component of the boundary graph, spanned with the edges that all tiles have passed
// on. `edge_count`: edges of the whole component, in any order. `e`: an edge may close a loop of more than e
// edges. `memory`: bytes. Arrays beyond it are mapped from files.
//
// Vertices are numbered by row: near in space, near in memory.
void find_component_loops(const Stitch<BoundaryEdge>::ForEachRecord& for_each_edge, std::uint64_t edge_count,
                          std::int64_t e, std::uint64_t memory, const Spill& spill, RawLoops& loops) {
  if (edge_count <= static_cast<std::uint64_t>(e)) return;  // a loop has more
  RowNumbers rows;
  rows.collect(edge_count, [&](auto&& add) {
    for_each_edge([&](const BoundaryEdge& edge) {
      add(edge.a.row);
      add(edge.b.row);
    });
  });
  if (rows.size() <= static_cast<std::uint64_t>(e)) return;
  Scratch scratch(spill.folder, memory / 3);
  const std::span<PointId> ids = scratch.array<PointId>(rows.size());
  for_each_edge([&](const BoundaryEdge& edge) {
    scratch.trim();
    ids[rows.number(edge.a.row)] = edge.a.id;
    ids[rows.number(edge.b.row)] = edge.b.id;
  });
  const auto for_each_passed = [&](const std::function<void(const PassedEdge&)>& visit) {
    for_each_edge([&](const BoundaryEdge& edge) {
      visit({rows.number(edge.a.row), rows.number(edge.b.row), edge.weight, edge.is_taken != 0});
    });
  };
  SpanningGraph cycles;
  {
    Scratch work(spill.folder, memory / 2);
    cycles = keep_cycles(span_whole(ids, for_each_passed, e, memory / 6, work), scratch);
  }
  Scratch search(spill.folder, memory / 3 * 2);
  find_loops_of(
      cycles, [&](LocalIndex v) { return rows.row(v); }, search, loops);
}

}  // namespace

FoundLoops PaperBoundary::find_loops(const TileOutputs& outputs) {
  stitch_->for_each_component([&](const auto& for_each_edge, std::uint64_t count, std::uint64_t memory) {
    find_component_loops(for_each_edge, count, minimum_loop_, memory, spill_, loops_);
  });
  return {.loops = loops_.with_points(outputs, tiling_, spill_, workers_.arena),
          .edges = edges_,
          .components = stitch_->components(),
          .minimum_loop = minimum_loop_};
}

}  // namespace lacuna::paper
