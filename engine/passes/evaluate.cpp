#include "engine/passes/evaluate.hpp"

#include "engine/core/merge_runs.hpp"
#include "engine/passes/balls.hpp"
#include "engine/passes/record_tile.hpp"
#include "engine/stages/evaluate.hpp"
#include "engine/stages/neighbourhoods.hpp"
#include "engine/stages/reach.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

namespace lacuna {
namespace {

// Cells of other tiles within eps of a tile's cells.
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

// Foreign points that a tile sees, each once, in ascending row.
struct Sight {
  std::vector<StoredPoint> points;
  std::vector<Row> rows;

  LocalIndex find(Row row) const {
    const auto at = std::lower_bound(rows.begin(), rows.end(), row);
    return static_cast<LocalIndex>(at - rows.begin());
  }
};

Sight foreign_sight(const TileStore& store, std::span<const Link> links,
                    std::span<const std::uint32_t> halo) {
  Sight sight;
  store.read_cells(halo, sight.points, sight.rows);
  std::vector<std::pair<Row, StoredPoint>> seen;
  for (std::size_t i = 0; i < sight.rows.size(); ++i) seen.emplace_back(sight.rows[i], sight.points[i]);
  for (const Link& link : links) seen.emplace_back(link.row, link.foreign);
  std::sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  seen.erase(
      std::unique(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
      seen.end());
  sight.points.clear();
  sight.rows.clear();
  for (const auto& [row, point] : seen) {
    sight.rows.push_back(row);
    sight.points.push_back(point);
  }
  return sight;
}

// `links` get sorted.
TilePoints gather(const TileStore& store, TileIndex index, std::vector<Link>& links,
                  std::span<const std::uint32_t> halo) {
  const Tile& tile = store.tiling().tiles[index];
  const Sight sight = foreign_sight(store, links, halo);
  TilePoints points;
  points.owned = static_cast<LocalIndex>(tile.points);
  points.positions.reserve(tile.points + sight.rows.size());
  points.ids.reserve(tile.points + sight.rows.size());
  const auto add = [&](const StoredPoint& p) {
    points.positions.push_back(p.position());
    points.ids.push_back(p.id);
  };
  store.for_each_point(index, add);
  std::for_each(sight.points.begin(), sight.points.end(), add);
  points.rows.reserve(tile.points + sight.rows.size());
  for (LocalIndex i = 0; i < tile.points; ++i) points.rows.push_back(tile.row(i));
  points.rows.insert(points.rows.end(), sight.rows.begin(), sight.rows.end());

  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return a.owned != b.owned ? a.owned < b.owned : a.row < b.row;
  });
  points.linked.offsets.reserve(tile.points + 1);
  auto link = links.begin();
  for (LocalIndex p = 0; p < points.owned; ++p) {
    for (; link != links.end() && link->owned == p; ++link) {
      if (link->incoming) points.linked.indices.push_back(points.owned + sight.find(link->row));
    }
    points.linked.offsets.push_back(static_cast<std::uint32_t>(points.linked.indices.size()));
  }
  return points;
}

void operator+=(Totals& totals, const Totals& more) {
  totals.neighbours += more.neighbours;
  totals.points += more.points;
  totals.candidates += more.candidates;
  totals.undefined_normals += more.undefined_normals;
  totals.edge_length += more.edge_length;
}

// A power of two that no edge is lost beside: 2^-60 of the scan's extent.
double length_unit(double extent) {
  return extent > 0 ? std::ldexp(1.0, std::ilogb(extent) - 60) : 1.0;
}

std::uint64_t blocks(std::uint64_t ids, const Job& job) {
  return job.config.output.points ? (ids + kResultBlock - 1) / kResultBlock : 0;
}

}  // namespace

EdgeLists::EdgeLists(const TileStore& store, const Job& job)
    : inside(job.file("edges"), store.tiling().tiles.size(), job.memory.spills / 4),
      crossings(job.file("crossings"), store.tiling().tiles.size(), job.memory.spills / 4),
      strengths(job.file("strengths")) {}

StarSpill::StarSpill(const Job& job, const std::string& name, std::size_t tiles, std::uint64_t budget)
    : stars_(job.file(name + "-stars"), tiles, budget / 4),
      corners_(job.file(name + "-corners"), tiles, budget - budget / 4) {}

void StarSpill::append(TileIndex tile, StoredStars stars) {
  const auto before = static_cast<std::uint32_t>(corners_.count(tile));
  for (StoredStar& star : stars.stars) star.place.begin += before;
  stars_.append(tile, stars.stars);
  corners_.append(tile, stars.corners);
}

StoredStars StarSpill::read(TileIndex tile) const {
  StoredStars stars{stars_.read(tile), corners_.read(tile)};
  merge_runs(stars.stars, [](const StoredStar& a, const StoredStar& b) { return a.owned < b.owned; });
  return stars;
}

void StarSpill::drop(TileIndex tile) {
  stars_.drop(tile);
  corners_.drop(tile);
}

StarLists::StarLists(const TileStore& store, const Job& job)
    : waiting(job.file("waiting"), store.tiling().tiles.size(), job.memory.spills / 16),
      waiting_neighbours(job.file("waiting-neighbours"), store.tiling().tiles.size(), job.memory.spills / 16),
      waiting_sight(job.file("waiting-sight"), store.tiling().tiles.size(), job.memory.spills / 16),
      around(store.tiling().tiles.size()),
      seats(job.file("seats")),
      rough(store.tiling().row_count()),
      unmeasured(store.tiling().row_count()),
      found(job, "found", store.tiling().tiles.size(), job.memory.spills / 16),
      open(job, "open", store.tiling().tiles.size(), job.memory.spills / 8),
      gaps(job.file("gaps"), store.tiling().tiles.size(), job.memory.spills / 8),
      open_gaps(job.file("open-gaps"), store.tiling().tiles.size(), job.memory.spills / 16) {}

void StarLists::drop_waiting(TileIndex tile) {
  waiting.drop(tile);
  waiting_neighbours.drop(tile);
  waiting_sight.drop(tile);
  found.drop(tile);
  open.drop(tile);
}

EvaluatedScan::EvaluatedScan(const TileStore& store, std::uint64_t result_blocks, const Job& job)
    : edges(store, job),
      stars(store, job),
      vertices(job.file("vertices"), store.tiling().tiles.size(), job.memory.spills / 12),
      candidates(job.file("candidates"), store.tiling().tiles.size(), job.memory.spills / 12),
      results(job.file("results"), result_blocks, job.memory.spills / 8),
      orientation(job.file("orientation"), store.tiling().tiles.size(), job.memory.spills / 16),
      orientation_crossings(job.file("orientation-crossings"), store.tiling().tiles.size(),
                            job.memory.spills / 16),
      normals(job.file("oriented-normals")),
      leaning(store.tiling().tiles.size()) {}

double EvaluatedScan::mean_neighbours() const {
  return totals.points == 0 ? 0 : static_cast<double>(totals.neighbours) / static_cast<double>(totals.points);
}

double EvaluatedScan::mean_edge_length() const {
  if (totals.neighbours == 0) return 0;
  return static_cast<double>(totals.edge_length) / static_cast<double>(totals.neighbours) *
         totals.length_unit;
}

EvaluatedScan evaluate_tiles(const TileStore& store, Spill<Link> links, std::uint64_t ids, double eps,
                             double extent, Job& job) {
  const Tiling& tiling = store.tiling();
  EvaluatedScan scan(store, blocks(ids, job), job);
  scan.totals.length_unit = length_unit(extent);
  Phase phase(job, "evaluate", tiling.points());

  std::vector<std::uint64_t> needs(tiling.tiles.size());
  job.crew.for_each(needs.size(), [&](std::size_t t) {
    const Tile& tile = tiling.tiles[t];
    std::uint64_t foreign = links.count(t);
    for (const std::uint32_t cell : halo_cells(tiling, tile, eps)) foreign += tiling.cells[cell].points;
    needs[t] = job.tile_bytes(tile.points) + foreign * 120 + ball_bytes(tiling, tile, eps, most_ball_bytes(job));
  });
  std::mutex mutex;
  job.crew.for_each_within(needs, job.memory.tiles, [&](std::size_t t) {
    const auto tile = static_cast<TileIndex>(t);
    std::vector<Link> inbox = links.read(t);
    links.drop(t);
    const TilePoints points = gather(store, tile, inbox, halo_cells(tiling, tiling.tiles[t], eps));
    std::vector<Link>().swap(inbox);
    const Rows neighbourhoods =
        find_neighbourhoods(points, static_cast<std::size_t>(job.config.neighbourhood.k), eps);
    const std::vector<Evaluation> evaluations =
        evaluate(points, neighbourhoods, store.normals(tile), job.config.normals, job.config.criteria);
    const TileNumbers numbers = record_tile({tile, points, neighbourhoods, evaluations}, scan, store, job);
    {
      const std::lock_guard lock(mutex);
      scan.totals += numbers.totals;
      for (const TileIndex on : numbers.leans_on) scan.leaning[on].push_back(tile);
    }
    phase.advance(points.owned);
  });
  return scan;
}

}  // namespace lacuna
