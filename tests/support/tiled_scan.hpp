// SPDX-License-Identifier: Apache-2.0
// What tests of single passes take: a cloud on its way through them, and loops that are drawn by a test.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/paper/paper_boundary.hpp"
#include "engine/bucket/bucket_scan.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/survey/survey.hpp"
#include "engine/thin/choose_points.hpp"
#include "engine/thin/level.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {

// Surveyed, split and bucketed, in a workspace of its own.
struct TiledScan {
  TiledScan(const Cloud& cloud, const Config& config);
  TiledScan(PointSource& scan, const Config& config);
  TiledScan(const TiledScan&) = delete;
  TiledScan& operator=(const TiledScan&) = delete;

  // Evaluates every point, for these consumers.
  TileOutputs evaluate(const std::vector<TileConsumer>& consumers);
  Totals totals(const TileOutputs& outputs) const;
  // All steps of a method behind the evaluation.
  FoundLoops find_loops(BoundaryMethod& method, const TileOutputs& outputs) const;

  std::vector<TileIndex> all_tiles() const;
  std::map<PointId, Row> rows() const;  // of the stored points
  TileIndex tile_of(Row row) const { return store.tiling().tile_of_row(row); }
  LocalIndex local(Row row) const;  // in its tile

  ScratchFolder folder;
  Config config;
  NoProgress quiet;
  Job job;
  Level level;
  TileStore& store;
};

// The distinct finite points of a cloud, in ascending id; a duplicate's lowest id stands for it.
std::vector<PointId> distinct_ids(const Cloud& cloud);

// ---- Representatives of the cells of a lattice, found plainly

using CellKey = std::array<double, 3>;

inline CellKey cell_of(const Eigen::Vector3d& position, double edge) {
  const Eigen::Vector3d cell = Lattice(edge).place_of(position).cell;
  return {cell.x(), cell.y(), cell.z()};
}

// Each occupied cell with the point that represents it.
inline std::map<CellKey, std::size_t> plainly_chosen(const Cloud& cloud, double edge) {
  const auto rank = [&](std::size_t i) {
    const Eigen::Vector3d& p = cloud.positions[i];
    return std::tuple(Lattice(edge).place_of(p).squared_offset, p.x(), p.y(), p.z(), i);
  };
  std::map<CellKey, std::size_t> chosen;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.positions[i].allFinite()) continue;
    std::size_t& best = chosen.try_emplace(cell_of(cloud.positions[i], edge), i).first->second;
    if (rank(i) < rank(best)) best = i;
  }
  return chosen;
}

// Their ids, ascending.
inline std::vector<std::size_t> plainly_chosen_ids(const Cloud& cloud, double edge) {
  std::vector<std::size_t> ids;
  for (const auto& [cell, id] : plainly_chosen(cloud, edge)) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace lacuna

namespace lacuna::test {

inline LoopPoint loop_point(std::uint64_t id, const Eigen::Vector3d& position,
                            const Eigen::Vector3f& surface = {0, 0, 0}, float probability = 0) {
  return {ScanPoint::at(position, PointId{id}), {surface.x(), surface.y(), surface.z()}, probability};
}

inline void move_to(LoopPoint& point, const Eigen::Vector3d& position) {
  static_cast<ScanPoint&>(point) = ScanPoint::at(position, point.id);
}

inline Eigen::Map<Eigen::Vector3f> surface_of(LoopPoint& point) {
  return Eigen::Map<Eigen::Vector3f>(point.surface.data());
}
inline Eigen::Vector3f surface_of(const LoopPoint& point) {
  return Eigen::Vector3f(point.surface.data());
}

struct DrawnLoop {
  std::vector<Eigen::Vector3d> points;
  LoopKind kind = LoopKind::kHole;
};

// A square, with `on_side` points from a corner to the next.
DrawnLoop square(double half, LoopKind kind, const Eigen::Vector3d& centre = {0, 0, 0}, int on_side = 5);

MeasuredLoops measured(std::span<const DrawnLoop> drawn, const std::filesystem::path& folder);

}  // namespace lacuna::test
