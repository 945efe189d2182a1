#include "engine/passes/bucket.hpp"

#include "engine/core/cell_index.hpp"
#include "engine/core/error.hpp"
#include "engine/core/index_file.hpp"
#include "engine/stages/order_tile.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

namespace lacuna {
namespace {

constexpr std::size_t kBatches = 4;  // in flight

// The tile of every cell.
std::vector<TileIndex> tiles_of_cells(const Tiling& tiling) {
  std::vector<TileIndex> tiles(tiling.cells.size());
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    const Tile& tile = tiling.tiles[t];
    std::fill(tiles.begin() + tile.first_cell, tiles.begin() + tile.last_cell, t);
  }
  return tiles;
}

// The finite points of one batch, sorted by tile.
struct Scattered {
  PointBatch batch;
  std::vector<StoredPoint> points;
  std::vector<StoredNormal> normals;
  std::vector<std::uint32_t> ends;  // of each tile's points

  void scatter(const CellIndex& index, std::span<const TileIndex> tile_of, std::size_t tile_count);

 private:
  std::vector<std::uint32_t> tiles;  // of each point of the batch; its cell at first
};

// A counting sort. What is not finite goes behind the last tile, and then away.
void Scattered::scatter(const CellIndex& index, std::span<const TileIndex> tile_of, std::size_t tile_count) {
  tiles.resize(batch.size());
  index.find(batch.positions, tiles);
  ends.assign(tile_count + 2, 0);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::uint32_t cell = tiles[i];
    const bool finite = batch.positions[i].allFinite();
    if (finite && cell == CellIndex::kNoCell) fail_changed("a point lies where none was counted");
    tiles[i] = finite ? tile_of[cell] : static_cast<TileIndex>(tile_count);
    ++ends[tiles[i] + 1];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  const std::uint32_t finite = ends[tile_count];
  points.resize(batch.size());
  normals.resize(batch.normals.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::uint32_t at = ends[tiles[i]]++;
    const Eigen::Vector3d p = batch.positions[i].array() + 0.0;  // -0 is 0
    points[at] = {p.x(), p.y(), p.z(), PointId{value(batch.first) + i}};
    if (!normals.empty()) normals[at] = {batch.normals[i].x(), batch.normals[i].y(), batch.normals[i].z()};
  }
  points.resize(finite);
  normals.resize(batch.normals.empty() ? 0 : finite);
  ends.resize(tile_count);
}

void append(const Scattered& batch, TileStore::Filler& filler) {
  std::uint32_t begin = 0;
  for (TileIndex tile = 0; tile < batch.ends.size(); ++tile) {
    const std::uint32_t count = batch.ends[tile] - begin;
    if (count > 0) {
      filler.append(tile, std::span(batch.points).subspan(begin, count),
                    batch.normals.empty() ? std::span<const StoredNormal>()
                                          : std::span(batch.normals).subspan(begin, count));
    }
    begin += count;
  }
}

template <class Record>
std::vector<Record> pick(const std::vector<Record>& records, std::span<const std::uint32_t> order) {
  std::vector<Record> picked;
  picked.reserve(order.size());
  for (const std::uint32_t i : order) picked.push_back(records[i]);
  return picked;
}

// Cells of a tile's points, counted from its first cell.
std::vector<std::uint32_t> cells_of(std::span<const StoredPoint> points, const CellIndex& index,
                                    const Tile& tile) {
  std::vector<std::uint32_t> cells(points.size());
  std::array<Eigen::Vector3d, 256> positions;
  for (std::size_t first = 0; first < points.size(); first += positions.size()) {
    const std::size_t count = std::min(positions.size(), points.size() - first);
    for (std::size_t i = 0; i < count; ++i) positions[i] = points[first + i].position();
    index.find(std::span(positions).first(count), std::span(cells).subspan(first, count));
  }
  for (std::uint32_t& cell : cells) cell -= tile.first_cell;
  return cells;
}

// Streams the scan into the store, every finite point into its tile.
void fill(TileStore& store, PointSource& scan, const CellIndex& index, Job& job, Phase& phase) {
  const std::vector<TileIndex> tile_of = tiles_of_cells(store.tiling());
  const std::size_t tile_count = store.tiling().tiles.size();
  TileStore::Filler filler(store, job.memory.tiles / 2);
  std::vector<Scattered> batches(kBatches);
  scan.rewind();
  job.crew.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                    [&](std::size_t slot) {
                      batches[slot].scatter(index, tile_of, tile_count);
                      append(batches[slot], filler);
                    },
                    [&](std::size_t slot) { phase.advance(batches[slot].points.size()); }, kBatches);
  filler.finish();
}

void count_points(Survey& survey, PointSource& scan, std::uint64_t expected, Job& job) {
  Phase phase(job, "survey", expected);
  struct Counted {
    PointBatch batch;
    std::optional<CellCounts> counts;  // none while the cell size is not known
  };
  std::vector<Counted> batches(kBatches);
  scan.rewind();
  job.crew.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                    [&](std::size_t slot) {
                      Counted& counted = batches[slot];
                      counted.counts.reset();
                      if (survey.is_sized()) counted.counts = count_cells(counted.batch, survey.finest());
                    },
                    [&](std::size_t slot) {
                      const Counted& counted = batches[slot];
                      counted.counts ? survey.add(*counted.counts) : survey.add(counted.batch);
                      phase.advance(counted.batch.size());
                    },
                    kBatches);
}

}  // namespace

SurveyedScan survey_scan(PointSource& scan, Job& job) {
  // Rarely more than once: where most points are far denser than the first ones.
  constexpr int kMostTimes = 4;
  const std::uint64_t expected = scan.expected_points().value_or(0);
  std::optional<CellGrid> finest;
  for (int time = 1;; ++time) {
    Survey survey(job.memory.cells, expected, finest);
    count_points(survey, scan, expected, job);
    finest = survey.finer();
    if (!finest || time == kMostTimes) return survey.finish();
  }
}

TileStore bucket_scan(PointSource& scan, Tiling tiling, Precision precision, Job& job) {
  std::uint64_t points = 0;
  for (const Tile& tile : tiling.tiles) points += tile.raw;
  Phase phase(job, "bucket", 2 * points);
  const CellIndex index(tiling);
  TileStore store(job.workspace, std::move(tiling), precision, scan.has_normals(), job.memory.spills / 8);
  fill(store, scan, index, job, phase);

  std::vector<std::uint64_t> needs;
  for (const Tile& tile : store.tiling().tiles) needs.push_back(tile.raw * 120);
  job.crew.for_each_within(needs, job.memory.tiles, [&](std::size_t t) {
    const auto number = static_cast<TileIndex>(t);
    const Tile& tile = store.tiling().tiles[t];
    const std::vector<StoredPoint> raw = store.raw_points(number);
    const std::vector<StoredNormal> normals = store.raw_normals(number);
    const OrderedTile ordered =
        order_tile(raw, cells_of(raw, index, tile), tile.last_cell - tile.first_cell, store.tiling().grid);
    store.put(number, pick(raw, ordered.order), store.has_normals() ? pick(normals, ordered.order) : normals,
              ordered.cell_points, ordered.duplicates);
    phase.advance(raw.size());
  });
  store.seal();
  if (job.config.run.keep_index) save_index(store.tiling(), job.file("index.vdb"));
  return store;
}

}  // namespace lacuna
