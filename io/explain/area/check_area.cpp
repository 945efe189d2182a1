// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/check_area.hpp"

#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/explain/area/empty_places.hpp"
#include "io/read/crs/crs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

// Whether a cell is empty and in no exception, so that its void counts.
bool has_voids(const PlanRaster& empty, const std::optional<PlanRaster>& excepted) {
  for (std::size_t row = 0; row < empty.rows(); ++row) {
    const std::span<const std::uint64_t> cells = empty.row(row);
    for (std::size_t word = 0; word < cells.size(); ++word)
      if ((cells[word] & ~(excepted ? excepted->row(row)[word] : 0)) != 0) return true;
  }
  return false;
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
    polygons += " in cells of " + print(check.outline_cell, unit) + ", without " +
                print(check.left_out, unit.empty() ? "" : unit + "²") + " of its convex hull";
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

// The area of the convex hull that the outline leaves out.
double left_out_of(const PlanOutline& outline) {
  ConvexHull hull;
  double area = 0;
  for (const std::vector<PlanPolygon>& polygons : outline.groups) {
    for (const PlanPolygon& polygon : polygons) {
      area += area_of(polygon);
      for (const Eigen::Vector2d& corner : polygon.front()) hull.add(corner);
    }
  }
  return std::max(area_of({hull.corners()}) - area, 0.0);
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
  check.voids = find_voids(grid, inside, excepted, points, config, tiles);
  for (const Void& each : check.voids) check.voids_area += each.area;
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

AreaCheck check_scan(const ScanFiles& scan, const FilesConfig& config, Progress& progress) {
  const double void_size = void_size_in(scan, config.area);
  Area area = read_area_files(scan, config, void_size);
  const bool is_outline = config.area.area.empty();
  PlanOutline outline;
  if (is_outline) {
    outline = outline_of_points(scan, void_size, progress);
    if (outline.groups.empty())
      throw Error("the points cover no area, so that the scan has no outline; --area states one");
  } else {
    outline.groups.push_back(std::move(area.polygons));
  }
  Eigen::AlignedBox2d bounds;
  for (const std::vector<PlanPolygon>& polygons : outline.groups) bounds.extend(bounds_of(polygons));
  const double left_out = is_outline ? left_out_of(outline) : 0;
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
  check->is_outline = is_outline;
  check->outline_cell = outline.cell;
  check->left_out = left_out;
  if (is_outline && (check->polygons.size() > 1 || outline.has_dust))
    check->undecided.push_back(Undecided::kSeveralParts);
  if (outline.has_bay) check->undecided.push_back(Undecided::kBay);
  check->basis = basis_of(*check, scan, config);
  progress.end();
  return std::move(*check);
}

}  // namespace lacuna::io
