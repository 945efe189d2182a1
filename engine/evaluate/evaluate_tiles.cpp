// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluate_tiles.hpp"

#include "engine/bucket/split.hpp"
#include "engine/criteria/criteria.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "engine/evaluate/totals.hpp"
#include "engine/halo/halo.hpp"
#include "engine/model/distance_bound.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "engine/simd/vectorised.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

// Returns the cells of other tiles within eps of a tile's cells.
std::vector<std::uint32_t> halo_cells(const Tiling& tiling, const Tile& tile, double eps) {
  std::vector<std::uint32_t> cells;
  if (eps == 0) return cells;
  for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell; ++cell) {
    for_each_cell_near(tiling, tiling.cells[cell].box, eps * eps, tile.first_cell, tile.last_cell,
                       [&](std::uint32_t near) {
                         cells.push_back(near);
                         return true;
                       });
    if (cells.size() > 4 * tiling.cells.size() || cell + 1 == tile.last_cell) {
      std::sort(cells.begin(), cells.end());
      cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    }
  }
  return cells;
}

// The halo points of a tile, each once, in ascending row.
struct HaloPoints {
  std::vector<ScanPoint> points;
  std::vector<Row> rows;

  LocalIndex find(Row row) const {
    const auto at = std::lower_bound(rows.begin(), rows.end(), row);
    return static_cast<LocalIndex>(at - rows.begin());
  }
};

HaloPoints halo_points(const TileStore& store, std::span<const HaloEdge> edges,
                       std::span<const std::uint32_t> cells) {
  HaloPoints foreign;
  store.read_cells(cells, foreign.points, foreign.rows);
  std::vector<std::pair<Row, ScanPoint>> entries;
  for (std::size_t i = 0; i < foreign.rows.size(); ++i)
    entries.emplace_back(foreign.rows[i], foreign.points[i]);
  for (const HaloEdge& edge : edges) entries.emplace_back(edge.row, edge.foreign);
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  entries.erase(std::unique(entries.begin(), entries.end(),
                            [](const auto& a, const auto& b) { return a.first == b.first; }),
                entries.end());
  foreign.points.clear();
  foreign.rows.clear();
  for (const auto& [row, point] : entries) {
    foreign.rows.push_back(row);
    foreign.points.push_back(point);
  }
  return foreign;
}

// Sorts `edges`.
TilePoints gather(const TileStore& store, TileIndex index, std::vector<HaloEdge>& edges,
                  std::span<const std::uint32_t> cells) {
  const Tile& tile = store.tiling().tiles[index];
  const HaloPoints foreign = halo_points(store, edges, cells);
  TilePoints points;
  points.owned = static_cast<LocalIndex>(tile.points);
  points.positions.reserve(tile.points + foreign.rows.size());
  points.ids.reserve(tile.points + foreign.rows.size());
  const auto add = [&](const ScanPoint& p) {
    points.positions.push_back(p.position());
    points.ids.push_back(p.id);
  };
  store.for_each_point(index, add);
  std::for_each(foreign.points.begin(), foreign.points.end(), add);
  points.rows.reserve(tile.points + foreign.rows.size());
  for (LocalIndex i = 0; i < tile.points; ++i) points.rows.push_back(tile.row(i));
  points.rows.insert(points.rows.end(), foreign.rows.begin(), foreign.rows.end());

  std::sort(edges.begin(), edges.end(), [](const HaloEdge& a, const HaloEdge& b) {
    return a.owned != b.owned ? a.owned < b.owned : a.row < b.row;
  });
  points.linked.offsets.reserve(tile.points + 1);
  auto edge = edges.begin();
  for (LocalIndex p = 0; p < points.owned; ++p) {
    for (; edge != edges.end() && edge->owned == p; ++edge) {
      if (edge->incoming) points.linked.indices.push_back(points.owned + foreign.find(edge->row));
    }
    points.linked.offsets.push_back(static_cast<std::uint32_t>(points.linked.indices.size()));
  }
  return points;
}

LACUNA_VECTORISED
LocalIndex largest_of(const LocalIndex* first, const LocalIndex* last) {
  LocalIndex largest = 0;
  for (; first < last; ++first) largest = std::max(largest, *first);
  return largest;
}

std::uint64_t points_of(std::span<const TileIndex> tiles, const Tiling& tiling) {
  std::uint64_t points = 0;
  for (const TileIndex t : tiles) points += tiling.tiles[t].points;
  return points;
}

// Returns for each owned point whether it has foreign neighbours. Few do, and these lie near each other.
std::vector<std::uint8_t> border_of(const TilePoints& points, const Neighbourhoods& neighbourhoods) {
  constexpr std::size_t kRun = 64;
  std::vector<std::uint8_t> is_border(points.owned);
  const auto leaves = [&](std::size_t first, std::size_t last) {
    const LocalIndex* const indices = neighbourhoods.indices.data();
    return largest_of(indices + neighbourhoods.offsets[first], indices + neighbourhoods.offsets[last]) >=
           points.owned;
  };
  for (std::size_t first = 0, last; first < is_border.size(); first = last) {
    last = std::min<std::size_t>(first + kRun, is_border.size());
    if (!leaves(first, last)) continue;
    for (std::size_t p = first; p < last; ++p) is_border[p] = leaves(p, p + 1);
  }
  return is_border;
}

// Returns the bytes that a tile's evaluation takes, with `edges` of the halo.
std::uint64_t bytes_of_tile(const Tiling& tiling, const Tile& tile, std::uint64_t edges, double eps,
                            const Config& config, const Memory& memory) {
  constexpr std::uint64_t kHaloPointBytes = 120;  // an edge, and its point twice
  std::uint64_t foreign = edges;
  if (eps > 0) {  // at most the cells near the box of the tile
    Eigen::AlignedBox3d box;
    for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell; ++cell)
      box.extend(Eigen::AlignedBox3d(tiling.cells[cell].box));
    for_each_cell_near(tiling, box, eps * eps, tile.first_cell, tile.last_cell, [&](std::uint32_t near) {
      foreign += tiling.cells[near].points;
      return true;
    });
  }
  return tile_bytes(tile.points, config) + foreign * kHaloPointBytes +
         ball_bytes(tiling, tile, eps, most_ball_bytes(memory));
}

}  // namespace

void evaluate_tiles(const Level& level, std::span<const TileIndex> tiles, AppendLists<HaloEdge> halo,
                    std::span<const TileConsumer> consumers, TileOutputs& outputs, Job& job) {
  const TileStore& store = level.store;
  const Tiling& tiling = store.tiling();
  const double eps = eps_length(job.config.neighbourhood, level.extent);
  Phase phase(job.phases, "evaluate", points_of(tiles, tiling));
  std::vector<std::uint64_t> needs(tiles.size());
  job.workers.arena.for_each(needs.size(), [&](std::size_t i) {
    needs[i] = bytes_of_tile(tiling, tiling.tiles[tiles[i]], halo.count(tiles[i]), eps, job.config,
                             job.workers.memory);
  });
  job.workers.for_each_within(job.workers.memory.tiles, needs, [&](std::size_t i) {
    const TileIndex index = tiles[i];
    const Tile& tile = tiling.tiles[index];
    std::vector<HaloEdge> inbox = halo.read(index);
    halo.drop(index);
    const TilePoints points = gather(store, index, inbox, halo_cells(tiling, tile, eps));
    std::vector<HaloEdge>().swap(inbox);
    const std::vector<Eigen::Vector3d> normals = store.normals(index);
    const Neighbourhoods neighbourhoods =
        find_neighbourhoods(points, static_cast<std::size_t>(job.config.neighbourhood.k), eps);
    std::vector<double> values(job.config.results.points ? points.owned * criteria().size() : 0);
    const std::vector<Evaluation> evaluations =
        evaluate(points, neighbourhoods, normals, job.config.normals, job.config.criteria, values);

    std::vector<LocalIndex> candidates;
    const Totals sums =
        sum_up(evaluations, neighbourhoods, job.config.coherence.threshold, level.extent, candidates);
    const std::vector<std::uint8_t> is_border = border_of(points, neighbourhoods);
    const EvaluatedTile evaluated{.index = index,
                                  .tile = tile,
                                  .points = points,
                                  .neighbourhoods = neighbourhoods,
                                  .evaluations = evaluations,
                                  .criteria = values,
                                  .candidates = candidates,
                                  .is_border = is_border};
    TileOutput output;
    emit_totals(sums, output);
    for (const TileConsumer& emit : consumers) emit(evaluated, output);
    outputs.add(index, output);
    phase.advance(tile.points);
  });
  outputs.finish();
}

}  // namespace lacuna
