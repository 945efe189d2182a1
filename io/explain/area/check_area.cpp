// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/check_area.hpp"

#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/explain/area/empty_places.hpp"
#include "io/explain/area/plan_shapes.hpp"
#include "io/read/crs/crs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include <spdlog/fmt/fmt.h>

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

// Whether a cell is empty and in no exception, so that its void counts.
bool has_voids(const PlanRaster& empty, const std::optional<PlanRaster>& excepted) {
  for (std::size_t row = 0; row < empty.rows(); ++row) {
    const std::span<const std::uint64_t> cells = empty.row(row);
    for (std::size_t word = 0; word < cells.size(); ++word)
      if ((cells[word] & ~(excepted ? excepted->row(row)[word] : 0)) != 0) return true;
  }
  return false;
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

// Cells of the voids that count, without exceptions.
PlanRaster missing_cells(const AreaCheck& check, const std::optional<PlanRaster>& excepted,
                         const PlanGrid& grid) {
  PlanRaster missing(grid);
  for (const Void& each : std::span(check.voids).first(check.counting()))
    for_each_run(each.outline, Frame::kScan, grid,
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
    for_each_run(each.outline, Frame::kScan, grid, [&](std::size_t row, std::size_t from, std::size_t to) {
      cells += to - from;
      within += count_bits(covered.row(row), from, to);
    });
    each.shares.push_back(static_cast<double>(within) / static_cast<double>(cells));
    if (each.counts) sum.voids_area += grid.area(within);
  }
}

bool has_other_systems(const ScanFiles& scan) {
  return scan.common_crs().empty() &&
         std::ranges::any_of(scan.files(), [](const ScanFile& file) { return !file.crs.empty(); });
}

std::vector<Undecided> undecided_reasons(const PlanOfPoints& points, const AreaCheck& check,
                                         const ScanFiles& scan) {
  std::vector<Undecided> reasons;
  const bool has_others = points.later_returns + points.synthetic > 0;
  if (points.hull.empty()) reasons.push_back(has_others ? Undecided::kNoFirstReturn : Undecided::kNoPoint);
  if (points.all_synthetic && points.points > 0) reasons.push_back(Undecided::kSyntheticAlone);
  if (has_other_systems(scan)) reasons.push_back(Undecided::kOtherSystems);
  if (check.counting() > 0 && check.spacing > AreaCheck::most_spacing(check.void_size))
    reasons.push_back(Undecided::kFewPoints);
  if (check.counting() > 0 && !points.apart.empty() && !points.has_voids_with_apart)
    reasons.push_back(Undecided::kHeightsApart);
  if (check.area_off > check.void_size / 2) reasons.push_back(Undecided::kCoarseConversion);
  return reasons;
}

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

AreaPolygon measure(PlanPolygon outline, const PlanGrid& grid, const PlanRaster& missing,
                    std::span<const MiddleCell> middles) {
  AreaPolygon polygon{.outline = std::move(outline)};
  std::uint64_t cells = 0, missing_cells = 0;
  for_each_run(polygon.outline, Frame::kScan, grid, [&](std::size_t row, std::size_t from, std::size_t to) {
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

// With bounds of heights, the user has said which points count.
double height_gap_of(const ScanFiles& scan, const FilesConfig& config, double void_size) {
  constexpr double kMetres = 100, kVoidSizes = 10;
  constexpr std::size_t kNumbersWithHeights = 6;
  if (config.input.bounds.size() == kNumbersWithHeights) return 0;
  return std::max(from_metres(kMetres, scan), kVoidSizes * void_size);
}

// Copies that files round differently lie some millimetres apart. Without times they must lie far nearer to
// each other than the points of the scan. Their spacing is no less than if all were in the area.
CopyDistance copy_distance_of(const ScanFiles& scan, double void_size, double area) {
  constexpr double kOfVoidSize = 200, kOfSpacing = 25, kLeast = 1e-6;
  const std::vector<std::uint64_t> rows = estimated_rows(scan);
  const double all =
      std::max(1.0, static_cast<double>(std::accumulate(rows.begin(), rows.end(), std::uint64_t{0})));
  const double with_time = void_size / kOfVoidSize;
  const double least = kLeast * void_size;
  return {with_time, std::clamp(std::sqrt(area / all) / kOfSpacing, least, std::max(with_time, least))};
}

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string print(double value, const std::string& unit) {
  return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::size_t files_with(const ScanFiles& scan, const char* column) {
  return static_cast<std::size_t>(std::ranges::count_if(
      scan.files(), [&](const ScanFile& file) { return file.layout.find_alike(column) != nullptr; }));
}

std::string returns_of(const ScanFiles& scan) {
  const std::size_t stated = files_with(scan, "return_number"), files = scan.files().size();
  if (stated == 0) return "all: no file states them";
  if (stated == files) return "first ones alone";
  return "first ones alone; all points of " + counted(files - stated, "file") + ", which state none";
}

std::string classes_of(const ScanFiles& scan, const InputConfig& config) {
  const bool is_stated = files_with(scan, "classification") > 0;
  std::string text = !is_stated          ? "all: no file states them"
                     : config.keep_noise ? "all"
                                         : "all but noise of LAS, 7 and 18";
  if (!config.where.empty()) text += ", where " + config.where;
  return text;
}

std::string swaths_of(const AreaCheck& check, const ScanFiles& scan) {
  if (files_with(scan, "point_source_id") == 0) return "all: no file states them";
  return counted(check.swaths.size(), "value") + " of point_source_id, taken together";
}

// Returns a line for each thing that decides what a figure is of: area, returns, classes, swaths, points.
std::vector<BasisLine> basis_of(const AreaCheck& check, const ScanFiles& scan, const FilesConfig& config) {
  const std::string& unit = scan.length_unit();
  std::string polygons = (check.is_outline ? "the scan's own outline" : config.area.area) + ", " +
                         counted(check.polygons.size(), "polygon");
  if (check.is_outline)
    polygons += ", without " + print(check.left_out, unit.empty() ? "" : unit + "²") + " of its convex hull";
  if (!config.area.except.empty()) polygons += "; voids in " + config.area.except + " do not count";
  const std::string least = print(check.void_size, unit);
  const std::string& rule = config.area.void_rule;
  std::string point = "covers what is nearer than " + print(check.void_size / 2, unit);
  if (std::isfinite(check.spacing)) point += "; spacing " + print(check.spacing, unit) + " where points are";
  if (!config.area.classes.empty()) polygons += "; map of " + config.area.classes;
  return {{"area", polygons},
          {"voids", "circles of " + least + " or more without points" +
                        (rule.find(':') == rule.npos ? "" : ", by the rule " + rule)},
          {"returns", returns_of(scan)},
          {"point classes", classes_of(scan, config.input)},
          {"swaths", swaths_of(check, scan)},
          {"a point", point}};
}

void sort_voids(AreaCheck& check) {
  std::sort(check.voids.begin(), check.voids.end(), [](const Void& a, const Void& b) {
    const auto key = [](const Void& v) { return std::tuple(!v.counts, -v.area, v.middle.x(), v.middle.y()); };
    return key(a) < key(b);
  });
}

AreaCheck check_cells(Area& area, double tile_edge, const ScanFiles& scan, const FilesConfig& config,
                      Progress& progress) {
  // What is empty: the cells of the area without a point near them.
  const PlanGrid& grid = area.grid;
  const PlanRaster inside = rasterise(area.polygons, grid);
  std::optional<PlanRaster> excepted;
  if (!area.exceptions.empty()) excepted = rasterise(area.exceptions, grid);
  AreaTiles tiles(tile_edge, grid);
  const PointRules rules{.height_gap = height_gap_of(scan, config, grid.size),
                         .copies = copy_distance_of(scan, grid.size, grid.area(inside.count()))};
  PlanOfPoints points =
      find_empty_places(grid, inside, rules, Memory::share(config.run.memory_limit).limit / 8, scan, tiles,
                        progress, [&](const PlanRaster& empty) { return has_voids(empty, excepted); });
  tiles.add_area(inside);

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
                  .near = points.near,
                  .swaths = points.swaths,
                  .counts = points.counts,
                  .counts_once = points.counts_once,
                  .apart = points.apart,
                  .height_gap = rules.height_gap,
                  .area_off = area.off};
  for (TracedVoid& traced : trace(plan, grid))
    check.voids_area += check.voids.emplace_back(plan.measure(std::move(traced), tiles)).area;
  sort_voids(check);
  check.undecided = undecided_reasons(points, check, scan);
  {  // one such raster at a time
    const PlanRaster missing = missing_cells(check, excepted, grid);
    check.missing_area = grid.area(missing.count());
    const std::vector<MiddleCell> middles = middles_of(check, grid);
    for (PlanPolygon& outline : area.polygons)
      check.polygons.push_back(measure(std::move(outline), grid, missing, middles));
  }
  for (const ClassPolygons& polygons : area.classes) add_class(polygons, grid, check);
  check.tile_edge = tile_edge;
  check.tiles = tiles.with_area();
  return check;
}

// Adds the check of other polygons of the area.
void add_check(AreaCheck&& other, AreaCheck& sum) {
  const auto with_points = [](const AreaCheck& check) {
    const double area = check.spacing * check.spacing * static_cast<double>(check.points);
    return std::isfinite(area) ? area : 0;
  };
  sum.spacing =
      std::sqrt((with_points(sum) + with_points(other)) / static_cast<double>(sum.points + other.points));
  std::ranges::move(other.polygons, std::back_inserter(sum.polygons));
  std::ranges::move(other.voids, std::back_inserter(sum.voids));
  std::ranges::move(other.apart, std::back_inserter(sum.apart));
  for (const auto sums : {&AreaCheck::area, &AreaCheck::voids_area, &AreaCheck::missing_area})
    sum.*sums += other.*sums;
  for (const auto counts : {&AreaCheck::points, &AreaCheck::later_returns, &AreaCheck::synthetic,
                            &AreaCheck::repeated, &AreaCheck::near})
    sum.*counts += other.*counts;
  for (std::size_t i = 0; i < sum.classes.size(); ++i)
    sum.classes[i].voids_area += other.classes[i].voids_area;
  for (const Undecided reason : other.undecided)
    if (std::ranges::find(sum.undecided, reason) == sum.undecided.end()) sum.undecided.push_back(reason);
  sum.swaths.merge(other.swaths);
  sum.counts_once = sum.counts_once && other.counts_once;
  for (const AreaTile& tile : other.tiles) {
    const auto same = std::ranges::find(sum.tiles, tile.corner, &AreaTile::corner);
    if (same == sum.tiles.end()) {
      sum.tiles.push_back(tile);
      continue;
    }
    same->area += tile.area;
    same->voids_area += tile.voids_area;
    same->points += tile.points;
    same->voids += tile.voids;
  }
  std::ranges::sort(sum.tiles, {},
                    [](const AreaTile& at) { return std::pair(at.corner.y(), at.corner.x()); });
  sort_voids(sum);
}

}  // namespace

AreaCheck check_area(Area area, const ScanFiles& scan, const FilesConfig& config, Progress& progress) {
  const double tile_edge = tile_edge_of(config, area.grid.size, bounds_of(area.polygons));
  AreaCheck check = check_cells(area, tile_edge, scan, config, progress);
  check.basis = basis_of(check, scan, config);
  progress.end();
  return check;
}

AreaCheck check_scan(const ScanFiles& scan, const FilesConfig& config, Progress& progress) {
  if (std::optional<Area> area = read_area(scan, config))
    return check_area(std::move(*area), scan, config, progress);
  const double void_size = void_size_in(scan, config.area);
  Area area = read_area_files(scan, config, void_size, "check");
  PlanOutline outline = outline_of_points(scan, void_size, progress);
  if (outline.groups.empty())
    throw Error("the points cover no area, so that the scan has no outline; --area states one");
  Eigen::AlignedBox2d bounds;
  ConvexHull hull;
  double outline_area = 0;
  for (const std::vector<PlanPolygon>& polygons : outline.groups) {
    bounds.extend(bounds_of(polygons));
    for (const PlanPolygon& polygon : polygons) {
      outline_area += area_of(polygon);
      for (const Eigen::Vector2d& corner : polygon.front()) hull.add(corner);
    }
  }
  const double tile_edge = tile_edge_of(config, void_size, bounds);
  std::optional<AreaCheck> check;
  for (std::vector<PlanPolygon>& polygons : outline.groups) {
    area.polygons = std::move(polygons);
    lay_cells(area, void_size, bounds_of(area.polygons), config);
    AreaCheck part = check_cells(area, tile_edge, scan, config, progress);
    if (check)
      add_check(std::move(part), *check);
    else
      check = std::move(part);
  }
  check->is_outline = true;
  check->left_out = std::max(area_of({hull.corners()}) - outline_area, 0.0);
  if (check->polygons.size() > 1 || outline.has_dust) check->undecided.push_back(Undecided::kSeveralParts);
  if (outline.has_bay) check->undecided.push_back(Undecided::kBay);
  check->basis = basis_of(*check, scan, config);
  progress.end();
  return std::move(*check);
}

}  // namespace lacuna::io
