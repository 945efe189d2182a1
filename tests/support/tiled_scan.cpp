// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tiled_scan.hpp"

#include "engine/halo/halo.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/parts/level_form.hpp"
#include "tests/support/detected.hpp"

namespace lacuna {
namespace {

Level make_level(PointSource& scan, Job& job) {
  SurveyedScan survey = survey_scan(scan, job);
  const TilePlan plan = plan_tiles(survey, job);
  const PointLayout layout{survey.precision(), scan.has_normals()};
  scan.rewind();
  const ScatteredPoints scattered = scatter_points(scan, plan, layout.precision, plan.points, job);
  TileStore store = store_tiles(
      plan, {}, survey.bounds, layout,
      [&](std::size_t place, const VisitPoints& visit) { scattered.for_each(place, visit); },
      temporary_store(job.spill), job.workers, job.phases);
  const double extent = extent_of(survey.bounds);
  return {.survey = survey, .extent = extent, .store = std::move(store), .represented = {}};
}

}  // namespace

TiledScan::TiledScan(const Cloud& cloud, const Config& config)
    : TiledScan(*std::make_unique<MemoryScan>(cloud), config) {}

TiledScan::TiledScan(PointSource& scan, const Config& given)
    : config(given), job(config, folder.path(), quiet), level(make_level(scan, job)), store(level.store) {}

TileOutputs TiledScan::evaluate(const std::vector<TileConsumer>& consumers) {
  TileOutputs outputs(store.tiling(), {}, {}, job.spill);
  const std::vector<TileIndex> tiles = all_tiles();
  evaluate_tiles(level, tiles, exchange_halo(store, tiles, job), consumers, outputs, job);
  return outputs;
}

Totals TiledScan::totals(const TileOutputs& outputs) const {
  return read_totals(outputs, store.tiling(), level.extent);
}

FoundLoops TiledScan::find_loops(BoundaryMethod& method, const TileOutputs& outputs) const {
  method.complete_edges(outputs);
  method.stitch(outputs, totals(outputs));
  return method.find_loops(outputs);
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
    for (const ScanPoint& p : store.points(t)) rows.emplace(p.id, Row{row++});
  }
  return rows;
}

LocalIndex TiledScan::local(Row row) const {
  return static_cast<LocalIndex>(value(row) - value(store.tiling().tiles[tile_of(row)].first_row));
}

std::vector<PointId> distinct_ids(const Cloud& cloud) {
  std::map<std::array<double, 3>, PointId> first_at;
  std::vector<PointId> ids;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d& p = cloud.positions[i];
    if (p.allFinite() && first_at.try_emplace({p.x(), p.y(), p.z()}, PointId{i}).second)
      ids.push_back(PointId{i});
  }
  return ids;
}

}  // namespace lacuna

namespace lacuna::test {

DrawnLoop square(double half, LoopKind kind, const Eigen::Vector3d& centre, int on_side) {
  DrawnLoop loop{.points = {}, .kind = kind};
  const std::vector<Eigen::Vector3d> corners = {
      {-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (int k = 0; k < on_side; ++k)
      loop.points.push_back(centre + corners[i] + (corners[(i + 1) % 4] - corners[i]) * k / on_side);
  }
  return loop;
}

MeasuredLoops measured(std::span<const DrawnLoop> drawn, const std::filesystem::path& folder) {
  MeasuredLoops loops;
  Loops& level = loops.loops.levels.emplace_back(folder / "loops");
  std::uint64_t id = 0;
  for (const DrawnLoop& loop : drawn) {
    Loop points;
    for (const Eigen::Vector3d& at : loop.points) points.push_back(loop_point(id++, at));
    level.add(points.size(), {}, [&](std::uint64_t i) { return points[i]; });
    loops.loops.chosen.push_back({0, static_cast<std::uint32_t>(loops.measures.size())});
    loops.measures.push_back(measure_loop(points, 1));
    loops.measures.back().kind = loop.kind;
  }
  return loops;
}

}  // namespace lacuna::test
