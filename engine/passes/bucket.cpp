#include "engine/passes/bucket.hpp"

#include "engine/core/cell_index.hpp"
#include "engine/core/error.hpp"
#include "engine/stages/order_tile.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

namespace lacuna {
namespace {

constexpr std::size_t kBatches = 4;  // in flight

// The points of one batch, sorted by tile.
struct Scattered {
  PointBatch batch;
  std::vector<StoredPoint> points;
  std::vector<StoredNormal> normals;
  std::vector<TileIndex> tiles;      // of each point
  std::vector<std::uint32_t> order;  // by tile

  void scatter(CellIndex::Reader& cells, const Tiling& tiling);
  template <class Visit>
  void for_each_tile(Visit&& visit) const;
};

void Scattered::scatter(CellIndex::Reader& cells, const Tiling& tiling) {
  points.clear();
  normals.clear();
  tiles.clear();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (!batch.positions[i].allFinite()) continue;
    const Eigen::Vector3d p = batch.positions[i].array() + 0.0;  // -0 is 0
    points.push_back({p.x(), p.y(), p.z(), PointId{value(batch.first) + i}});
    tiles.push_back(tiling.tile_of_cell(cells.cell_of(p)));
    if (!batch.normals.empty()) {
      const Eigen::Vector3d& n = batch.normals[i];
      normals.push_back({n.x(), n.y(), n.z()});
    }
  }
  order.resize(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return tiles[a] < tiles[b]; });
}

template <class Visit>
void Scattered::for_each_tile(Visit&& visit) const {
  for (std::size_t begin = 0, end; begin < order.size(); begin = end) {
    end = begin;
    while (end < order.size() && tiles[order[end]] == tiles[order[begin]]) ++end;
    visit(tiles[order[begin]], std::span(order).subspan(begin, end - begin));
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
  CellIndex::Reader reader(index);
  std::vector<std::uint32_t> cells;
  cells.reserve(points.size());
  for (const StoredPoint& p : points) cells.push_back(reader.cell_of(p.position()) - tile.first_cell);
  return cells;
}

}  // namespace

SurveyedScan survey_scan(PointSource& scan, Job& job) {
  const std::uint64_t expected = scan.expected_points().value_or(0);
  Phase phase(job, "survey", expected);
  Survey survey(job.memory.cells, expected);
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
  return survey.finish();
}

TileStore bucket_scan(PointSource& scan, Tiling tiling, Job& job) {
  const std::size_t tile_count = tiling.tiles.size();
  std::uint64_t points = 0;
  for (const Tile& tile : tiling.tiles) points += tile.raw;
  Phase phase(job, "bucket", 2 * points);
  const CellIndex index(tiling);
  const bool with_normals = scan.has_normals();
  Spill<StoredPoint> raw(job.file("raw"), tile_count, job.memory.spills / 2);
  Spill<StoredNormal> raw_normals(job.file("raw-normals"), tile_count, job.memory.spills / 4);

  std::vector<Scattered> batches(kBatches);
  std::vector<std::unique_ptr<CellIndex::Reader>> readers;
  for (std::size_t i = 0; i < kBatches; ++i) readers.push_back(std::make_unique<CellIndex::Reader>(index));
  std::uint64_t stored = 0;
  scan.rewind();
  job.crew.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                    [&](std::size_t slot) { batches[slot].scatter(*readers[slot], tiling); },
                    [&](std::size_t slot) {
                      const Scattered& batch = batches[slot];
                      // One consumer: points and normals of a tile arrive in the same order.
                      batch.for_each_tile([&](TileIndex tile, std::span<const std::uint32_t> order) {
                        raw.append(tile, pick(batch.points, order));
                        if (with_normals) raw_normals.append(tile, pick(batch.normals, order));
                      });
                      stored += batch.points.size();
                      phase.advance(batch.points.size());
                    },
                    kBatches);
  if (stored != points) throw Error("the input changed while it was read: not the points that were counted");

  TileStore store(job.workspace, std::move(tiling), with_normals, job.memory.spills / 8);
  std::vector<std::uint64_t> needs;
  for (const Tile& tile : store.tiling().tiles) needs.push_back(tile.raw * 120);
  job.crew.for_each_within(needs, job.memory.tiles, [&](std::size_t t) {
    const Tile& tile = store.tiling().tiles[t];
    const std::vector<StoredPoint> tile_points = raw.read(t);
    const std::vector<StoredNormal> normals = raw_normals.read(t);
    raw.drop(t);
    raw_normals.drop(t);
    const OrderedTile ordered = order_tile(tile_points, cells_of(tile_points, index, tile),
                                           tile.last_cell - tile.first_cell, store.tiling().grid);
    store.put(static_cast<TileIndex>(t), pick(tile_points, ordered.order),
              with_normals ? pick(normals, ordered.order) : normals, ordered.cell_points, ordered.duplicates);
    phase.advance(tile_points.size());
  });
  store.seal();
  CellIndex::save(store.tiling(), job.file("index.vdb"));
  return store;
}

}  // namespace lacuna
