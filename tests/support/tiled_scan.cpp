// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tiled_scan.hpp"

#include "engine/bucket/split.hpp"
#include "engine/halo/halo.hpp"
#include "engine/levels/sealed_level.hpp"
#include "tests/support/memory_scan.hpp"

#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

namespace lacuna {
namespace {

TileStore make_store(PointSource& scan, SurveyedScan& survey, Job& job) {
  const std::uint64_t points = survey.points - survey.dropped, tile_points = job.tile_points(points);
  TilePlan plan = split_tiles(std::move(survey.cells), survey.grid, points, tile_points);
  plan.cell_points = job.cell_points(points);
  return bucket_scan(scan, std::move(plan), survey.bounds, survey.precision(), level_files(0, job), job);
}

}  // namespace

TiledScan::TiledScan(const Cloud& cloud, const Config& config)
    : TiledScan(*std::make_unique<MemoryScan>(cloud), config) {}

TiledScan::TiledScan(PointSource& scan, const Config& given)
    : config(given),
      job(config, folder.path(), quiet),
      survey(survey_scan(scan, job)),
      store(make_store(scan, survey, job)) {}

Totals TiledScan::evaluate(std::vector<TileConsumer*> consumers) {
  const double extent = survey.bounds.isEmpty() ? 0 : survey.bounds.diagonal().norm();
  const std::vector<TileIndex> tiles = all_tiles();
  Totals totals(extent);
  std::mutex mutex;
  evaluate_tiles(store, tiles, exchange_halo(store, tiles, job), config.neighbourhood.eps, extent, consumers,
                 job,
                 [&](TileIndex t, const TileOutput& output) {
                   for (TileConsumer* const consumer : consumers) consumer->absorb(t, output);
                   const std::lock_guard lock(mutex);
                   totals.add(output);
                 },
                 {});
  return totals;
}

std::vector<TileIndex> TiledScan::all_tiles() const {
  std::vector<TileIndex> tiles(store.tiling().tiles.size());
  std::iota(tiles.begin(), tiles.end(), TileIndex{0});
  return tiles;
}

std::map<PointId, Row> TiledScan::rows() const {
  std::map<PointId, Row> rows;
  const std::vector<Tile>& tiles = store.tiling().tiles;
  for (TileIndex t = 0; t < tiles.size(); ++t) {
    std::uint64_t row = value(tiles[t].first_row);
    for (const StoredPoint& p : store.points(t)) rows.emplace(p.id, Row{row++});
  }
  return rows;
}

LocalIndex TiledScan::local(Row row) const {
  return static_cast<LocalIndex>(value(row) - value(store.tiling().tiles[tile_of(row)].first_row));
}

}  // namespace lacuna
