// SPDX-License-Identifier: Apache-2.0
// The voids of an area: what the circles around its empty places cover.
//
// Idea: rows of cells near empty ones are made one by one. GDAL traces them to outlines, and each outline
// gathers its cells.
#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/explain/area/check_area.hpp"
#include "io/explain/area/empty_places.hpp"
#include "io/read/crs/crs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace lacuna::io {
namespace {

// Edges of outlines across rows that fit in memory.
std::uint64_t most_edges(const FilesConfig& config) {
  constexpr std::uint64_t kBytesPerEdge = 200;
  return Memory::share(config.run.memory_limit).limit / 4 / kBytesPerEdge;
}

[[noreturn]] void fail_long_outlines(std::uint64_t edges, const FilesConfig& config) {
  throw Error("void_rule = " + config.area.void_rule +
              ": the points are so far apart that outlines of voids have at least " + std::to_string(edges) +
              " edges, more than the " + std::to_string(most_edges(config)) +
              " that fit in the memory limit; allowed: a larger size");
}

// The plan of an area and its voids.
class Plan {
 public:
  Plan(const PlanGrid& grid, const PlanRaster& inside, const std::optional<PlanRaster>& excepted,
       const PlanOfPoints& points)
      : grid_(grid), inside_(inside), excepted_(excepted), points_(points), hull_(grid.rows) {
    for_each_run({points.hull}, Frame::kCells, grid, [&](std::size_t row, std::size_t from, std::size_t to) {
      hull_[row] = {from, to};
    });
  }

  // Writes one more than the kind of void of each cell of a row, kHole or kOutside; 0: no void. What is
  // around is not known yet.
  void write_row(std::size_t row, std::span<std::uint8_t> values) const {
    std::fill(values.begin(), values.end(), 0);
    const auto put = [&](VoidKind kind) {
      std::vector<std::uint64_t> voids(inside_.row(row).size());
      const auto copy = [&](std::size_t of, std::span<std::uint64_t> cells) { copy_empty(of, kind, cells); };
      grow_row(grid_, copy, row, kEmptyRadius, voids);
      for (std::size_t word = 0; word < voids.size(); ++word) {
        for (std::uint64_t bits = voids[word] & inside_.row(row)[word]; bits != 0; bits &= bits - 1)
          values[word * 64 + static_cast<std::size_t>(std::countr_zero(bits))] = value_of(kind);
      }
    };
    put(VoidKind::kOutside);
    put(VoidKind::kHole);  // wins where circles overlap
  }

  // Throws `Error` where the outlines of the voids do not fit in memory.
  void refuse_long_outlines(const FilesConfig& config) const {
    std::vector<std::uint8_t> values(grid_.columns + 1);
    std::uint64_t edges = 0;
    for (std::size_t row = 0; row < grid_.rows; ++row) {
      write_row(row, std::span(values).first(grid_.columns));
      for (std::size_t column = 0; column < grid_.columns; ++column)
        edges += values[column] != values[column + 1];
    }
    if (edges > most_edges(config)) fail_long_outlines(edges, config);
  }

  Void measure(TracedVoid&& traced, AreaTiles& tiles) const {
    Void result;
    result.kind = kind_of(traced);
    std::uint64_t cells = 0, excepted = 0;
    result.counts = !excepted_;
    for_each_run(traced.outline, Frame::kCells, grid_,
                 [&](std::size_t row, std::size_t from, std::size_t to) {
                   cells += to - from;
                   tiles.add_void_cells(row, from, to);
                   if (!excepted_) return;
                   excepted += count_bits(excepted_->row(row), from, to);
                   for (std::size_t column = from; column < to && !result.counts; ++column)
                     result.counts = points_.empty.has(column, row) && !excepted_->has(column, row);
                 });
    if (result.counts)
      tiles.add_void(static_cast<std::size_t>(traced.middle.x()),
                     static_cast<std::size_t>(traced.middle.y()));
    result.area = grid_.area(cells);
    result.excepted = static_cast<double>(excepted) / static_cast<double>(cells);
    // The outline runs along cells, so the circle within it is up to half a cell too small all around.
    result.circle = std::max(2 * (traced.radius + 0.5) * grid_.edge(), grid_.size);
    result.middle = grid_.from_cells(traced.middle);
    result.spacing = points_.density.spacing_around(traced.outline, inside_) * grid_.edge();
    result.outline = std::move(traced.outline);
    for (Ring2& ring : result.outline)
      for (Eigen::Vector2d& corner : ring) corner = grid_.from_cells(corner);
    return result;
  }

 private:
  static std::uint8_t value_of(VoidKind kind) { return static_cast<std::uint8_t>(kind) + 1; }

  // Copies the empty places of a row beyond the convex hull, or the ones within.
  void copy_empty(std::size_t row, VoidKind kind, std::span<std::uint64_t> cells) const {
    const std::span<const std::uint64_t> empty = points_.empty.row(row);
    std::copy(empty.begin(), empty.end(), cells.begin());
    const auto [from, to] = hull_[row];
    if (kind == VoidKind::kOutside) {
      clear_bits(cells, from, to);
    } else {
      clear_bits(cells, 0, from);
      clear_bits(cells, std::max(from, to), grid_.columns);
    }
  }

  bool is_in_hull(std::size_t column, std::size_t row) const {
    return column >= hull_[row].first && column < hull_[row].second;
  }

  // A hole has points all around it, as the area and the hull go on.
  VoidKind kind_of(const TracedVoid& traced) const {
    if (traced.value == value_of(VoidKind::kOutside)) return VoidKind::kOutside;
    const auto is_beyond = [&](double x, double y) {  // the cell with this middle
      if (!grid_.contains({x, y})) return true;
      const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
      return !inside_.has(column, row) || !is_in_hull(column, row);
    };
    for (const Ring2& ring : traced.outline) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        const double length = (b - a).norm();
        const Eigen::Vector2d along = (b - a) / length, across(-along.y() / 2, along.x() / 2);
        for (double at = 0.5; at < length; ++at) {
          const Eigen::Vector2d left = a + along * at + across, right = a + along * at - across;
          if (is_beyond(left.x(), left.y()) || is_beyond(right.x(), right.y())) return VoidKind::kOpen;
        }
      }
    }
    return VoidKind::kHole;
  }

  const PlanGrid& grid_;
  const PlanRaster& inside_;
  const std::optional<PlanRaster>& excepted_;
  const PlanOfPoints& points_;
  std::vector<std::pair<std::size_t, std::size_t>> hull_;  // by row: the cells within the convex hull
};

// Traces the voids. The convex hull may cut off slivers. They are left out: a quarter of a circle at least is
// in the area, of each other void.
std::vector<TracedVoid> trace(const Plan& plan, const PlanGrid& grid) {
  static auto* const trace = reinterpret_cast<TraceVoids*>(load_gis_function(kTraceVoids, kAreaOptions));
  TraceTask task{.raster = {.columns = grid.columns,
                            .rows = grid.rows,
                            .row = [&](std::size_t row, std::span<std::uint8_t> values) {
                              plan.write_row(row, values);
                            }}};
  trace(task);
  constexpr double kLeastArea = std::numbers::pi * kEmptyRadius * kEmptyRadius / 4;
  std::erase_if(task.voids, [](const TracedVoid& each) { return area_of(each.outline) < kLeastArea; });
  return std::move(task.voids);
}

}  // namespace

std::vector<Void> find_voids(const PlanGrid& grid, const PlanRaster& inside,
                             const std::optional<PlanRaster>& excepted, const PlanOfPoints& points,
                             const FilesConfig& config, AreaTiles& tiles) {
  const Plan plan(grid, inside, excepted, points);
  plan.refuse_long_outlines(config);
  std::vector<Void> voids;
  for (TracedVoid& traced : trace(plan, grid)) voids.push_back(plan.measure(std::move(traced), tiles));
  return voids;
}

}  // namespace lacuna::io
