// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluate_tiles.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "engine/halo/distance_bound.hpp"
#include "engine/halo/eps_balls.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "engine/simd/vectorised.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <utility>
#include <vector>

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

// The halo points of a tile, each once, in ascending row.
struct HaloPoints {
  std::vector<StoredPoint> points;
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
  std::vector<std::pair<Row, StoredPoint>> entries;
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
  const auto add = [&](const StoredPoint& p) {
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

// Rows as parts have them: those of other tiles do not matter.
TileContent content_of(const TilePoints& points, std::span<const Eigen::Vector3d> normals,
                       const Tiling& tiling, double eps, double unit) {
  std::vector<Row> foreign(points.rows.begin() + points.owned, points.rows.end());
  for (Row& row : foreign) row = to_stored_row(row, tiling);
  const std::array<double, 2> lengths = {eps, unit};
  Hash hash;
  hash.add(std::as_bytes(std::span(points.positions)));
  hash.add(std::as_bytes(std::span(points.ids)));
  hash.add(std::as_bytes(std::span(foreign)));
  hash.add(std::as_bytes(std::span(points.linked.offsets)));
  hash.add(std::as_bytes(std::span(points.linked.indices)));
  hash.add(std::as_bytes(normals));
  hash.add(std::as_bytes(std::span(lengths)));
  return hash.digest();
}

LACUNA_VECTORISED
LocalIndex largest_of(const LocalIndex* first, const LocalIndex* last) {
  LocalIndex largest = 0;
  for (; first < last; ++first) largest = std::max(largest, *first);
  return largest;
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

// A power of two so small that no edge is lost: 2^-60 of the scan's extent.
double length_unit(double extent) {
  return extent > 0 ? std::ldexp(1.0, std::ilogb(extent) - 60) : 1.0;
}

// The sums of a tile as its output has them.
struct TileSums {
  std::uint64_t points, neighbours, candidates, undefined_normals;
  ProbabilityBins probabilities;
  std::uint64_t edge_length_low;
  std::int64_t edge_length_high;
};
struct DistanceBin {
  std::uint64_t bin, count;
};

void emit_sums(const Totals& sums, TileOutput& output) {
  std::vector<TileSums> stored(1);
  stored.front() = {.points = sums.points,
                    .neighbours = sums.neighbours,
                    .candidates = sums.candidates,
                    .undefined_normals = sums.undefined_normals,
                    .probabilities = sums.probabilities,
                    .edge_length_low = static_cast<std::uint64_t>(sums.edge_length),
                    .edge_length_high = static_cast<std::int64_t>(sums.edge_length >> 64)};
  output.add("sums", std::move(stored));
  std::vector<DistanceBin> bins;
  for (const auto& [bin, count] : sums.distances.counts) bins.push_back({bin, count});
  output.add("distances", std::move(bins));
}

// One sweep for the candidates and the tile's sums: the evaluations do not fit in the cache.
Totals sum_up(std::span<const Evaluation> evaluations, const Neighbourhoods& neighbourhoods, double threshold,
              double extent, std::vector<LocalIndex>& candidates) {
  Totals totals(extent);
  totals.points = evaluations.size();
  totals.neighbours = neighbourhoods.indices.size();
  std::vector<std::uint32_t> distances(LengthBins::bin_of(std::numeric_limits<double>::infinity()));
  for (LocalIndex p = 0; p < evaluations.size(); ++p) {
    const Evaluation& e = evaluations[p];
    if (e.probability > threshold) candidates.push_back(p);
    ++totals.probabilities[std::min(kProbabilityBins - 1,
                                    static_cast<std::size_t>(e.probability * kProbabilityBins))];
    totals.undefined_normals += !e.normal.allFinite();
    if (e.mean_distance > 0 && std::isfinite(e.mean_distance))
      ++distances[LengthBins::bin_of(e.mean_distance)];
    const double length =
        e.mean_distance * static_cast<double>(neighbourhoods[p].size()) / totals.length_unit;
    constexpr double kShort = 0x1p62;  // what fits is converted in one instruction
    totals.edge_length += length < kShort ? static_cast<std::int64_t>(length) : static_cast<Int128>(length);
  }
  totals.candidates = candidates.size();
  for (std::uint32_t bin = 0; bin < distances.size(); ++bin)
    if (distances[bin] > 0) totals.distances.counts[bin] = distances[bin];
  return totals;
}

}  // namespace

std::uint32_t LengthBins::bin_of(double length) {
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(length) >> kShift);
}

double LengthBins::start_of(std::uint32_t bin) {
  return std::bit_cast<double>(std::uint64_t{bin} << kShift);
}

double LengthBins::median() const {
  std::uint64_t all = 0, before = 0;
  for (const auto& [bin, count] : counts) all += count;
  for (const auto& [bin, count] : counts) {
    if (2 * (before + count) >= all) {
      const double part =
          (static_cast<double>(all) / 2 - static_cast<double>(before)) / static_cast<double>(count);
      return start_of(bin) + part * (start_of(bin + 1) - start_of(bin));
    }
    before += count;
  }
  return 0;
}

double LengthBins::sum_of_squares() const {
  double sum = 0;
  for (const auto& [bin, count] : counts)
    sum += static_cast<double>(count) * start_of(bin) * start_of(bin + 1);
  return sum;
}

Totals::Totals(double extent) : length_unit(lacuna::length_unit(extent)) {}

void Totals::add(const TileOutput& output) {
  for (const TileSums& sums : output.read<TileSums>("sums")) {
    points += sums.points;
    neighbours += sums.neighbours;
    candidates += sums.candidates;
    undefined_normals += sums.undefined_normals;
    edge_length += (Int128{sums.edge_length_high} << 64) + sums.edge_length_low;
    for (std::size_t bin = 0; bin < kProbabilityBins; ++bin) probabilities[bin] += sums.probabilities[bin];
  }
  for (const DistanceBin& bin : output.read<DistanceBin>("distances"))
    distances.counts[static_cast<std::uint32_t>(bin.bin)] += bin.count;
}

double Totals::mean_neighbours() const {
  return points == 0 ? 0 : static_cast<double>(neighbours) / static_cast<double>(points);
}

double Totals::mean_edge_length() const {
  if (neighbours == 0) return 0;
  return static_cast<double>(edge_length) / static_cast<double>(neighbours) * length_unit;
}

double Totals::surface_area() const {
  return std::numbers::pi * 2.25 * distances.sum_of_squares() / (mean_neighbours() + 2.5);
}

void evaluate_tiles(
    const TileStore& store, std::span<const TileIndex> tiles, AppendLists<HaloEdge> halo, double eps,
    double extent, std::span<TileConsumer* const> consumers, Job& job,
    const std::function<void(TileIndex, const TileOutput&)>& take,
    const std::function<std::optional<TileOutput>(TileIndex, const TileContent&)>& find_known) {
  const Tiling& tiling = store.tiling();
  std::vector<std::uint64_t> needs(tiles.size());
  job.arena.for_each(needs.size(), [&](std::size_t i) {
    const Tile& tile = tiling.tiles[tiles[i]];
    std::uint64_t foreign = halo.count(tiles[i]);
    for (const std::uint32_t cell : halo_cells(tiling, tile, eps)) foreign += tiling.cells[cell].points;
    needs[i] =
        job.tile_bytes(tile.points) + foreign * 120 + ball_bytes(tiling, tile, eps, most_ball_bytes(job));
  });
  job.arena.for_each_within_budget(needs, job.memory.tiles, [&](std::size_t i) {
    const TileIndex index = tiles[i];
    const Tile& tile = tiling.tiles[index];
    std::vector<HaloEdge> inbox = halo.read(index);
    halo.drop(index);
    const TilePoints points = gather(store, index, inbox, halo_cells(tiling, tile, eps));
    std::vector<HaloEdge>().swap(inbox);
    const std::vector<Eigen::Vector3d> normals = store.normals(index);
    TileContent content{};
    if (!job.kept.empty()) {
      content = content_of(points, normals, tiling, eps, length_unit(extent));
      if (const std::optional<TileOutput> known = find_known(index, content)) return take(index, *known);
    }
    const Neighbourhoods neighbourhoods =
        find_neighbourhoods(points, static_cast<std::size_t>(job.config.neighbourhood.k), eps);
    std::vector<double> values(job.config.results.points ? points.owned * criteria().size() : 0);
    const std::vector<Evaluation> evaluations =
        evaluate(points, neighbourhoods, normals, job.config.normals, job.config.criteria, values);

    std::vector<LocalIndex> candidates;
    const Totals sums =
        sum_up(evaluations, neighbourhoods, job.config.coherence.threshold, extent, candidates);
    const std::vector<std::uint8_t> is_border = border_of(points, neighbourhoods);
    const EvaluatedTile evaluated{index,       tile,   points,     neighbourhoods,
                                  evaluations, values, candidates, is_border};
    TileOutput output;
    output.set_content(content);
    emit_sums(sums, output);
    for (const TileConsumer* const consumer : consumers) consumer->emit(evaluated, output);
    take(index, output);
  });
}

}  // namespace lacuna
