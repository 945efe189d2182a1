// SPDX-License-Identifier: Apache-2.0
#include "io/area/check_area.hpp"

#include "engine/run/error.hpp"
#include "engine/run/job.hpp"
#include "io/area/area_basis.hpp"
#include "io/area/area_polygons.hpp"
#include "io/area/area_tiles.hpp"
#include "io/area/empty_places.hpp"
#include "io/area/plan_raster.hpp"
#include "io/area/trace_voids.hpp"
#include "io/crs/gis_module.hpp"
#include "io/scan/plan_system.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <sstream>
#include <tuple>
#include <utility>

#include <spdlog/spdlog.h>

namespace lacuna::io {
namespace {

constexpr const char* kUser = "--area, --except and --classes";

// ---- the area

std::vector<PlanPolygon> read_polygons(const std::string& file, const FileScan& scan) {
  static auto* const read = reinterpret_cast<ReadAreaPolygons*>(load_gis_function(kReadAreaPolygons, kUser));
  AreaPolygons polygons{.file = file, .crs = scan.common_crs()};
  read(polygons);
  if (polygons.is_converted) spdlog::info("{}: is converted from {}", file, polygons.file_crs);
  if (!polygons.is_converted && polygons.file_crs.empty() != scan.common_crs().empty())
    spdlog::warn("{}: {} has no coordinate reference system; positions are compared as they are", file,
                 polygons.file_crs.empty() ? "it" : "the scan");
  return std::move(polygons.polygons);
}

std::vector<ClassPolygons> read_classes(const std::string& files, const FileScan& scan) {
  std::vector<ClassPolygons> classes;
  std::istringstream names(files);
  for (std::string file; std::getline(names, file, ',');) {
    if (file.empty()) continue;
    std::error_code error;
    if (file.find_first_not_of("0123456789") == file.npos && !std::filesystem::exists(file, error))
      throw Error(
          file + ": no such file; --classes takes files of polygons, and --where 'Classification == " + file +
          "' chooses points by their class");
    const std::string name = std::filesystem::path(file).stem().string();
    const bool is_there = std::ranges::find(classes, name, &ClassPolygons::name) != classes.end();
    if (is_there) throw Error(file + ": a file of --classes before it has this name, too: " + name);
    classes.push_back({name, read_polygons(file, scan)});
  }
  return classes;
}

// The cells over all polygons.
PlanGrid grid_over(std::span<const PlanPolygon> polygons, std::size_t rasters, const FilesConfig& config) {
  Eigen::AlignedBox2d bounds;
  for (const PlanPolygon& polygon : polygons)
    for (const Ring2& ring : polygon)
      for (const Eigen::Vector2d& corner : ring) bounds.extend(corner);
  PlanGrid grid{.size = void_size_of(config.area)};
  grid.first = grid.to_cells(bounds.min()).array().floor();
  const Eigen::Array2d size = grid.to_cells(bounds.max()).array().ceil();
  const double most = static_cast<double>(Memory::share(config.run.memory_limit).limit / 2 * 8 / rasters);
  if (!(size.prod() <= most) || !(size.maxCoeff() < std::numeric_limits<int>::max())) {
    std::ostringstream message;
    message << "void_rule = " << config.area.void_rule << ": the area has " << size.x() << " x " << size.y()
            << " cells of an eighth of this size, more than " << most
            << " within the memory limit; allowed: a size of "
            << grid.size * std::sqrt(std::max(size.prod() / most, 1.0)) * 1.01 << " or more";
    throw Error(message.str());
  }
  grid.columns = static_cast<std::size_t>(size.x());
  grid.rows = static_cast<std::size_t>(size.y());
  return grid;
}

// ---- the voids

// The plan of an area and its voids.
class Plan {
 public:
  Plan(const PlanGrid& grid, const PlanRaster& inside, const std::optional<PlanRaster>& excepted,
       const PlanOfPoints& points)
      : grid_(grid), inside_(inside), excepted_(excepted), points_(points), hull_(grid.rows) {
    for_each_run({points.hull}, grid, [&](std::size_t row, std::size_t from, std::size_t to) {
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
    constexpr double kBytesPerEdge = 200;
    std::vector<std::uint8_t> values(grid_.columns + 1);
    double edges = 0;
    for (std::size_t row = 0; row < grid_.rows; ++row) {
      write_row(row, std::span(values).first(grid_.columns));
      for (std::size_t column = 0; column < grid_.columns; ++column)
        edges += values[column] != values[column + 1];
    }
    const auto limit = static_cast<double>(Memory::share(config.run.memory_limit).limit);
    if (edges * kBytesPerEdge <= limit / 4) return;
    std::ostringstream message;
    message << "void_rule = " << config.area.void_rule
            << ": the points are so far apart that outlines of voids have " << edges
            << " edges, more than fit in the memory limit; allowed: a larger size";
    throw Error(message.str());
  }

  Void measure(TracedVoid&& traced, AreaTiles& tiles) const {
    Void result;
    result.kind = kind_of(traced);
    std::uint64_t cells = 0, excepted = 0;
    result.counts = !excepted_;
    for_each_run(traced.outline, grid_, [&](std::size_t row, std::size_t from, std::size_t to) {
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

// In cells; the first ring is the outer one.
double area_of(const PlanPolygon& polygon) {
  double area = 0;
  for (std::size_t ring = 0; ring < polygon.size(); ++ring) {
    const Ring2& corners = polygon[ring];
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    area += (ring == 0 ? 0.5 : -0.5) * std::fabs(twice);
  }
  return area;
}

// Traces the voids. The convex hull may cut off slivers. They are left out: a quarter of a circle at least is
// in the area, of each other void.
std::vector<TracedVoid> trace(const Plan& plan, const PlanGrid& grid) {
  static auto* const trace = reinterpret_cast<TraceVoids*>(load_gis_function(kTraceVoids, kUser));
  TraceTask task{
      .columns = grid.columns,
      .rows = grid.rows,
      .row = [&](std::size_t row, std::span<std::uint8_t> values) { plan.write_row(row, values); }};
  trace(task);
  constexpr double kLeastArea = std::numbers::pi * kEmptyRadius * kEmptyRadius / 4;
  std::erase_if(task.voids, [](const TracedVoid& each) { return area_of(each.outline) < kLeastArea; });
  return std::move(task.voids);
}

// Cells of the voids that count, without exceptions.
PlanRaster missing_cells(const AreaCheck& check, const std::optional<PlanRaster>& excepted,
                         const PlanGrid& grid) {
  PlanRaster missing(grid);
  for (const Void& each : std::span(check.voids).first(check.counting()))
    for_each_run(to_cells(each.outline, grid), grid,
                 [&](std::size_t row, std::size_t from, std::size_t to) { missing.set(row, from, to); });
  if (excepted) missing.subtract(*excepted);
  return missing;
}

// Adds the share of each void within a class, and their sum.
void add_class(const ClassPolygons& polygons, const PlanGrid& grid, AreaCheck& check) {
  const PlanRaster covered = rasterise(polygons.polygons, grid);
  AreaClass& sum = check.classes.emplace_back(AreaClass{.name = polygons.name});
  for (Void& each : check.voids) {
    std::uint64_t cells = 0, within = 0;
    for_each_run(to_cells(each.outline, grid), grid, [&](std::size_t row, std::size_t from, std::size_t to) {
      cells += to - from;
      within += count_bits(covered.row(row), from, to);
    });
    each.shares.push_back(static_cast<double>(within) / static_cast<double>(cells));
    if (each.counts) sum.voids_area += grid.area(within);
  }
}

bool has_other_systems(const FileScan& scan) {
  return scan.common_crs().empty() &&
         std::ranges::any_of(scan.files(), [](const ScanFile& file) { return !file.crs.empty(); });
}

std::vector<Undecided> undecided_reasons(const PlanOfPoints& points, const AreaCheck& check,
                                         const FileScan& scan) {
  std::vector<Undecided> reasons;
  const bool has_others = points.later_returns + points.synthetic > 0;
  if (points.hull.empty()) reasons.push_back(has_others ? Undecided::kNoFirstReturn : Undecided::kNoPoint);
  if (points.all_synthetic && points.points > 0) reasons.push_back(Undecided::kSyntheticAlone);
  if (has_other_systems(scan)) reasons.push_back(Undecided::kOtherSystems);
  if (check.counting() > 0 && check.spacing > AreaCheck::most_spacing(check.void_size))
    reasons.push_back(Undecided::kFewPoints);
  return reasons;
}

// ---- the polygons

// The largest circle of a void, by the cell of its middle.
struct MiddleCell {
  std::size_t row, column;
  double circle;
};

std::vector<MiddleCell> middles_of(const AreaCheck& check, const PlanGrid& grid) {
  std::vector<MiddleCell> middles;
  for (const Void& each : std::span(check.voids).first(check.counting())) {
    const Eigen::Vector2d at = grid.to_cells(each.middle);
    middles.push_back({static_cast<std::size_t>(at.y()), static_cast<std::size_t>(at.x()), each.circle});
  }
  std::ranges::sort(middles, {}, [](const MiddleCell& at) { return std::pair(at.row, at.column); });
  return middles;
}

AreaPolygon measure(const PlanPolygon& outline, const PlanGrid& grid, const PlanRaster& missing,
                    std::span<const MiddleCell> middles) {
  AreaPolygon polygon{.outline = outline};
  std::uint64_t cells = 0, missing_cells = 0;
  for_each_run(to_cells(outline, grid), grid, [&](std::size_t row, std::size_t from, std::size_t to) {
    cells += to - from;
    missing_cells += count_bits(missing.row(row), from, to);
    auto at = std::ranges::lower_bound(middles, std::pair(row, from), {}, [](const MiddleCell& middle) {
      return std::pair(middle.row, middle.column);
    });
    for (; at != middles.end() && at->row == row && at->column < to; ++at)
      polygon.circle = std::max(polygon.circle, at->circle);
  });
  polygon.area = grid.area(cells);
  polygon.missing_area = grid.area(missing_cells);
  return polygon;
}

}  // namespace

std::optional<Area> read_area(const FileScan& scan, const FilesConfig& config) {
  if (config.area.area.empty()) return std::nullopt;
  require_plan(scan, "--area");
  Area area;
  area.polygons = read_polygons(config.area.area, scan);
  if (!config.area.except.empty()) area.exceptions = read_polygons(config.area.except, scan);
  area.classes = read_classes(config.area.classes, scan);
  area.grid = grid_over(area.polygons, area.exceptions.empty() ? 3 : 4, config);
  return area;
}

AreaCheck check_area(const Area& area, FileScan& scan, const FilesConfig& config, Progress& progress) {
  // What is empty: the cells of the area without a point near them.
  const PlanGrid& grid = area.grid;
  const PlanRaster inside = rasterise(area.polygons, grid);
  std::optional<PlanRaster> excepted;
  if (!area.exceptions.empty()) excepted = rasterise(area.exceptions, grid);
  AreaTiles tiles(config.area.area_tile, grid);
  tiles.add_area(inside);
  const PlanOfPoints points = find_empty_places(
      grid, inside, Memory::share(config.run.memory_limit).limit / 8, scan, tiles, progress);

  // The voids: the circles around what is empty.
  const Plan plan(grid, inside, excepted, points);
  plan.refuse_long_outlines(config);
  AreaCheck check{.void_size = grid.size,
                  .area = grid.area(inside.count()),
                  .spacing = points.density.spacing(inside) * grid.edge(),
                  .points = points.points,
                  .later_returns = points.later_returns,
                  .synthetic = points.synthetic,
                  .repeated = points.repeated,
                  .counts_once = points.counts_once};
  for (TracedVoid& traced : trace(plan, grid))
    check.voids_area += check.voids.emplace_back(plan.measure(std::move(traced), tiles)).area;
  std::sort(check.voids.begin(), check.voids.end(), [](const Void& a, const Void& b) {
    const auto key = [](const Void& v) { return std::tuple(!v.counts, -v.area, v.middle.x(), v.middle.y()); };
    return key(a) < key(b);
  });
  check.undecided = undecided_reasons(points, check, scan);
  check.basis = basis_of(check, area, points, scan, config);
  {  // one such raster at a time
    const PlanRaster missing = missing_cells(check, excepted, grid);
    check.missing_area = grid.area(missing.count());
    const std::vector<MiddleCell> middles = middles_of(check, grid);
    for (const PlanPolygon& outline : area.polygons)
      check.polygons.push_back(measure(outline, grid, missing, middles));
  }
  for (const ClassPolygons& polygons : area.classes) add_class(polygons, grid, check);
  progress.end();
  check.tile_edge = config.area.area_tile;
  check.tiles = tiles.with_area();
  return check;
}

}  // namespace lacuna::io
