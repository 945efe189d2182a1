// SPDX-License-Identifier: Apache-2.0
#include "io/area/plan_estimate.hpp"

#include "engine/run/error.hpp"
#include "io/area/empty_places.hpp"
#include "io/area/plan_outline.hpp"
#include "io/area/plan_raster.hpp"
#include "io/area/trace_voids.hpp"
#include "io/crs/gis_module.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lacuna::io {

namespace {

std::optional<PlanEstimate> estimate(const Detection& detection) {
  constexpr double kMostHeight = 0.25, kMostSurface = 2, kSpacings = 6;
  constexpr std::uint64_t kLeastPoints = 1000, kLeastMemory = std::uint64_t{256} << 20;  // of GDAL
  const Eigen::AlignedBox3d& box = detection.summary.strays.rest;
  const std::uint64_t points = detection.sampled_points;
  if (box.isEmpty() || points < kLeastPoints || detection.summary.memory_limit < kLeastMemory)
    return std::nullopt;
  const Eigen::AlignedBox2d plan(box.min().head<2>(), box.max().head<2>());
  if (!(box.sizes().z() <= kMostHeight * plan.sizes().minCoeff())) return std::nullopt;
  auto* const trace = reinterpret_cast<TraceVoids*>(find_gis_function(kTraceVoids));
  if (trace == nullptr) return std::nullopt;

  const PlanGrid grid = grid_around(plan, kSpacings * std::sqrt(plan.volume() / static_cast<double>(points)));
  PlanRaster empty(grid);
  empty.fill();
  detection.for_each_sampled_point([&](const SampledPoint& point) {
    clear_disc(grid.to_cells(point.position().head<2>()), kEmptyRadius, empty);
  });
  const PlanRaster inside = rasterise(outline_of_points(empty, grid, bay_of(plan)), grid);
  empty.intersect(inside);

  PlanEstimate found{.area = grid.area(inside.count())};
  if (detection.summary.surface_area > kMostSurface * found.area) return std::nullopt;
  const CopyRow copy = [&](std::size_t row, std::span<std::uint64_t> cells) {
    std::ranges::copy(empty.row(row), cells.begin());
  };
  std::vector<std::uint64_t> cells((grid.columns + 63) / 64);
  TraceTask task{.raster = {.columns = grid.columns,
                            .rows = grid.rows,
                            .row = [&](std::size_t row, std::span<std::uint8_t> values) {
                              std::ranges::fill(cells, 0);
                              grow_row(grid, copy, row, kEmptyRadius, cells);
                              for (std::size_t column = 0; column < values.size(); ++column)
                                values[column] = static_cast<std::uint8_t>(cells[column / 64] >> column % 64 &
                                                                           1 & inside.has(column, row));
                            }}};
  trace(task);
  for (const TracedVoid& each : task.voids) {
    for_each_run({each.outline}, Frame::kCells, grid, [&](std::size_t, std::size_t from, std::size_t to) {
      found.uncovered += grid.area(to - from);
    });
    found.widest = std::max(found.widest, 2 * each.radius * grid.edge());
  }
  return found;
}

}  // namespace

std::optional<PlanEstimate> estimate_plan(const Detection& detection) try {
  return estimate(detection);
} catch (const Error&) {
  return std::nullopt;  // a remark in a summary is no reason to fail
}

}  // namespace lacuna::io
