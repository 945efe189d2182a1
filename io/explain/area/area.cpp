// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/area.hpp"

#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"
#include "engine/run/memory.hpp"
#include "io/explain/area/area_polygons.hpp"
#include "io/explain/area/plan_shapes.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numeric>
#include <sstream>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

namespace lacuna::io {

double from_metres(double metres, const ScanFiles& scan) {
  return metres / metres_of_unit(scan.length_unit()).value_or(1);
}

double void_size_in(const ScanFiles& scan, const AreaConfig& config) {
  const VoidSize size = void_size_of(config);
  const std::optional<double> metres = metres_of_unit(scan.length_unit());
  const std::string rule = "void_rule = " + config.void_rule;
  if (!size.unit.empty()) {
    if (!metres)
      throw Error(rule + " is a length in " + std::string(size.unit) +
                  ", and the scan states no unit; --unit states it");
    return size.length * *metres_of_unit(size.unit) / *metres;
  }
  if (size.is_standards && metres && *metres != 1)
    spdlog::warn(
        "{}: the spacing is taken in {}, so that voids have {:.3g} m; standards are in metres, and a "
        "unit may follow the number, as in anps:0.71m",
        rule, scan.length_unit(), size.length * *metres);
  return size.length;
}

Eigen::AlignedBox2d bounds_of(std::span<const PlanPolygon> polygons) {
  Eigen::AlignedBox2d bounds;
  for (const PlanPolygon& polygon : polygons)
    for (const Ring2& ring : polygon)
      for (const Eigen::Vector2d& corner : ring) bounds.extend(corner);
  return bounds;
}

namespace {

// GDAL opens those next to a Shapefile, too.
void check_files(const std::filesystem::path& file) {
  constexpr const char* kNeeded = "a file of polygons";
  check_regular_file(file, kNeeded);
  for (const char* const ending : {".shp", ".shx", ".dbf", ".prj", ".cpg", ".qix", ".sbn"}) {
    const std::filesystem::path other = std::filesystem::path(file).replace_extension(ending);
    std::error_code error;
    if (std::filesystem::exists(other, error)) check_regular_file(other, kNeeded);
  }
}

// Reads the files of an area, whose corners share the memory.
class PolygonFiles {
 public:
  PolygonFiles(const ScanFiles& scan, const FilesConfig& config, double void_size)
      : scan_(scan), memory_(Memory::share(config.run.memory_limit).limit / 8 * 3), void_size_(void_size) {}

  std::vector<PlanPolygon> read(const std::string& file) {
    constexpr double kBends = 500;  // of the void size, as exact as circles are
    static auto* const read =
        reinterpret_cast<ReadAreaPolygons*>(load_gis_function(kReadAreaPolygons, kAreaOptions));
    HeldPolygons polygons{.file = file,
                          .crs = scan_.common_crs(),
                          .bend = void_size_ / kBends,
                          .corners = corners_,
                          .most_in_one = most_in_one_,
                          .memory = memory_};
    check_files(file);
    const bool is_geojson = looks_like_geojson(file);
    if (is_geojson) read_geojson_polygons(polygons);
    if (!is_geojson || !polygons.polygons.empty()) read(polygons);
    if (polygons.polygons.empty()) throw Error(file + ": has no polygon");
    corners_ = polygons.corners;
    most_in_one_ = polygons.most_in_one;
    if (polygons.is_converted) spdlog::info("{}: is converted from {}", file, polygons.file_crs);
    note_accuracy(polygons);
    if (!polygons.is_converted && polygons.file_crs.empty() != scan_.common_crs().empty())
      spdlog::warn("{}: {} has no coordinate reference system; positions are compared as they are", file,
                   polygons.file_crs.empty() ? "it" : "the scan");
    return std::move(polygons.polygons);
  }

  std::uint64_t bytes() const { return bytes_of_corners(corners_, most_in_one_); }
  double off() const { return off_; }  // of all files so far, where their conversion moves the datum

 private:
  // A conversion within one datum is how all programs convert: polygons come back as they were.
  void note_accuracy(const HeldPolygons& polygons) {
    const double off = from_metres(polygons.accuracy.metres, scan_);
    if (polygons.accuracy.moves_datum) off_ = std::max(off_, off);
    if (!(off > void_size_ / 2)) return;
    spdlog::warn("{}: the conversion from {} holds {}", polygons.file, polygons.file_crs,
                 polygons.accuracy.print());
  }

  const ScanFiles& scan_;
  std::uint64_t memory_, corners_ = 0, most_in_one_ = 0;
  double void_size_, off_ = 0;
};

std::vector<ClassPolygons> read_classes(const std::string& files, PolygonFiles& polygons) {
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
    classes.push_back({name, polygons.read(file)});
  }
  return classes;
}

// Returns how many cells of an eighth of a size are over the box, along x and y.
Eigen::Array2d cells_over(const Eigen::AlignedBox2d& bounds, double void_size) {
  const PlanGrid grid{.size = void_size};
  return grid.to_cells(bounds.max()).array().ceil() - grid.to_cells(bounds.min()).array().floor();
}

// Bytes of so many rasters, whose rows are whole words, and of lists of rows and columns.
double bytes_of(const Eigen::Array2d& cells, std::size_t rasters) {
  constexpr double kOfRow = 32, kOfColumn = 8, kWord = 64;
  return cells.y() * (std::ceil(cells.x() / kWord) * 8 * static_cast<double>(rasters) + kOfRow) +
         cells.x() * kOfColumn;
}

// The cells over a box, in `memory` bytes.
PlanGrid grid_over(const Eigen::AlignedBox2d& bounds, double void_size, std::size_t rasters, double memory,
                   const AreaConfig& config) {
  PlanGrid grid{.size = void_size};
  const auto fits = [&](const Eigen::Array2d& cells) {
    return bytes_of(cells, rasters) <= memory && cells.maxCoeff() < std::numeric_limits<int>::max();
  };
  const Eigen::Array2d cells = cells_over(bounds, grid.size);
  if (!fits(cells)) {
    constexpr double kStep = 1.05;
    double allowed = grid.size;
    while (std::isfinite(allowed) && !fits(cells_over(bounds, allowed))) allowed *= kStep;
    throw Error(fmt::format(
        "void_rule = {}: the area has {:g} x {:g} cells of an eighth of this size, more than fit in the {:g} "
        "MiB that the memory limit leaves for them; allowed: a size of {:g} or more, or a part of the area",
        config.void_rule, cells.x(), cells.y(), std::floor(memory / (1 << 20)), allowed));
  }
  return PlanGrid::over(bounds, void_size);
}

// Throws `Error` where the squares of the table do not fit in `memory` bytes.
void check_tiles(const PlanGrid& grid, double memory, const AreaConfig& config) {
  constexpr double kBytesOfTile = 240;
  if (!(config.area_tile > 0)) return;
  if (config.area_tile < grid.size)
    throw Error("area_tile is less than the void size, " + print_number(grid.size) +
                "; allowed: 0 (off), or a length of this or more");
  const double cells = config.area_tile / grid.edge();  // along an edge
  const double tiles =
      (static_cast<double>(grid.columns) / cells + 2) * (static_cast<double>(grid.rows) / cells + 2);
  if (tiles * kBytesOfTile <= memory) return;
  throw Error(
      fmt::format("area_tile = {:g}: the area has {:g} squares with this edge, more than fit in the {:g} MiB "
                  "that the memory limit leaves for them; allowed: an edge of {:g} or more",
                  config.area_tile, std::floor(tiles), std::floor(memory / (1 << 20)),
                  config.area_tile * std::sqrt(tiles * kBytesOfTile / memory) * 1.1));
}

}  // namespace

void lay_cells(Area& area, double void_size, const Eigen::AlignedBox2d& bounds, const FilesConfig& config) {
  const auto limit = static_cast<double>(Memory::share(config.run.memory_limit).limit);
  area.grid = grid_over(bounds, void_size, area.exceptions.empty() ? 3 : 4,
                        limit / 2 - static_cast<double>(area.bytes), config.area);
  check_tiles(area.grid, limit / 8, config.area);
}

Area read_area_files(const ScanFiles& scan, const FilesConfig& config, double void_size, const char* user) {
  require_plan(scan, user);
  Area area;
  PolygonFiles files(scan, config, void_size);
  if (!config.area.area.empty()) area.polygons = files.read(config.area.area);
  if (!config.area.except.empty()) area.exceptions = files.read(config.area.except);
  area.off = files.off();
  area.classes = read_classes(config.area.classes, files);
  area.bytes = files.bytes();
  return area;
}

std::optional<Area> read_area(const ScanFiles& scan, const FilesConfig& config) {
  if (config.area.area.empty()) return std::nullopt;
  const double void_size = void_size_in(scan, config.area);
  Area area = read_area_files(scan, config, void_size, "--area");
  lay_cells(area, void_size, bounds_of(area.polygons), config);
  return area;
}

double tile_edge_of(const FilesConfig& config, double void_size, const Eigen::AlignedBox2d& bounds) {
  constexpr double kAlongMap = 50;
  if (config.area.area_tile > 0 || !config.area.is_check || !config.output.report)
    return config.area.area_tile;
  const double least = std::max(void_size, bounds.sizes().maxCoeff() / kAlongMap);
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double edge : {power, 2 * power, 5 * power})
    if (edge >= least) return edge;
  return 10 * power;
}

namespace {

using PlanCell = std::pair<double, double>;  // whole numbers of edges

struct PlanCellHash {
  std::size_t operator()(const PlanCell& cell) const {
    return std::hash<double>{}(cell.first) * 31 + std::hash<double>{}(cell.second);
  }
};

// The points of a cell that are furthest to the east, west, north and south. Equal ones do not depend on the
// order of the points.
class FurthestPoints {
 public:
  explicit FurthestPoints(const Eigen::Vector2d& point) { points.fill(point); }

  void add(const Eigen::Vector2d& point) {
    for (std::size_t side = 0; side < points.size(); ++side)
      if (key(side, point) > key(side, points[side])) points[side] = point;
  }

  std::array<Eigen::Vector2d, 4> points;

 private:
  static std::pair<double, double> key(std::size_t side, const Eigen::Vector2d& point) {
    const double sign = side % 2 == 0 ? 1 : -1;
    return side < 2 ? std::pair(sign * point.x(), point.y()) : std::pair(sign * point.y(), point.x());
  }
};

// Holds the cells with points. Their edge is a power of two, and doubles where there are too many.
class PointCells : public RowObserver {
 public:
  explicit PointCells(Progress& progress) : progress_(progress) {}

  void take(std::size_t, const ScanReader&, const RowBatch&, std::span<const Eigen::Vector3d>,
            std::span<const Eigen::Vector3d> kept) final {
    for (const Eigen::Vector3d& point : kept) {
      if (!point.allFinite()) continue;
      if (cells.empty()) level_ = std::max(std::ilogb(point.head<2>().cwiseAbs().maxCoeff()), -kBits) - kBits;
      add(point.head<2>(), level_, cells);
      while (cells.size() > kMost) coarsen();
    }
    progress_.advance(kept.size());
  }

  double edge() const { return std::ldexp(1, level_); }

  void coarsen() {
    ++level_;
    Cells coarser;
    for (const auto& [cell, furthest] : cells)
      for (const Eigen::Vector2d& point : furthest.points)
        if (&point == &furthest.points[0] || point != furthest.points[0]) add(point, level_, coarser);
    cells = std::move(coarser);
  }

  // Whether nearly all cells have three neighbours or more. So corners of an area have, and lines have not.
  bool is_area() const {
    constexpr std::size_t kNeighbours = 3, kFew = 20;  // one in so many may be lone
    constexpr double kExact = std::uint64_t{1} << kBits;
    std::size_t lone = 0;
    for (const auto& [cell, furthest] : cells) {
      std::size_t near = 0;
      for_each_within(1, cell, [&](const PlanCell& other) { near += other != cell; });
      lone += near < kNeighbours || std::max(std::fabs(cell.first), std::fabs(cell.second)) > kExact;
      if (lone * kFew > cells.size()) return false;
    }
    return true;
  }

  // Calls visit(cell) for the cells with points so many cells around.
  template <class Visit>
  void for_each_within(int reach, const PlanCell& cell, const Visit& visit) const {
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y)
        if (const PlanCell other(cell.first + x, cell.second + y); cells.contains(other)) visit(other);
  }

  using Cells = std::unordered_map<PlanCell, FurthestPoints, PlanCellHash>;
  Cells cells;

 private:
  static constexpr std::size_t kMost = 1 << 16;
  static constexpr int kBits = 50;  // of the numbers of cells, so that all have neighbours

  static void add(const Eigen::Vector2d& point, int level, Cells& to) {
    const Eigen::Array2d at = (point.array() / std::ldexp(1, level)).floor() + 0.0;  // no -0
    const auto [place, is_new] = to.try_emplace(PlanCell(at.x(), at.y()), point);
    if (!is_new) place->second.add(point);
  }

  int level_ = 0;
  Progress& progress_;
};

constexpr int kReach = 2;  // in edges of cells

// Cells near each other.
struct CellGroup {
  std::vector<PlanCell> cells;
  Eigen::AlignedBox2d box;  // of their points, and the reach around
};

// Returns the groups of cells whose points may be within twice the reach. A group has a hundredth of the
// cells of the largest one at least.
std::vector<CellGroup> groups_of(const PointCells& points) {
  constexpr std::size_t kOfLargest = 100;
  std::vector<PlanCell> all;
  for (const auto& [cell, furthest] : points.cells) all.push_back(cell);
  std::sort(all.begin(), all.end());
  std::unordered_map<PlanCell, bool, PlanCellHash> is_taken;
  std::vector<CellGroup> groups;
  std::size_t largest = 0;
  for (const PlanCell& first : all) {
    if (is_taken[first]) continue;
    is_taken[first] = true;
    CellGroup group{.cells = {first}, .box = {}};
    for (std::size_t i = 0; i < group.cells.size(); ++i) {
      points.for_each_within(2 * kReach, PlanCell(group.cells[i]), [&](const PlanCell& other) {
        if (!std::exchange(is_taken[other], true)) group.cells.push_back(other);
      });
      for (const Eigen::Vector2d& point : points.cells.at(group.cells[i]).points) group.box.extend(point);
    }
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kReach * points.edge());
    group.box = Eigen::AlignedBox2d(group.box.min() - margin, group.box.max() + margin);
    largest = std::max(largest, group.cells.size());
    groups.push_back(std::move(group));
  }
  std::erase_if(groups, [&](const CellGroup& each) { return each.cells.size() * kOfLargest < largest; });
  return groups;
}

// Joins groups whose boxes overlap, or have half of their common box.
void join(std::vector<CellGroup>& groups) {
  constexpr double kMostLarger = 2;
  for (std::size_t i = 0; i < groups.size();) {
    const auto other = std::find_if(groups.begin() + static_cast<std::ptrdiff_t>(i) + 1, groups.end(),
                                    [&](const CellGroup& each) {
                                      const double both = groups[i].box.volume() + each.box.volume();
                                      return groups[i].box.intersects(each.box) ||
                                             groups[i].box.merged(each.box).volume() <= kMostLarger * both;
                                    });
    if (other == groups.end()) {
      ++i;
      continue;
    }
    groups[i].box.extend(other->box);
    groups[i].cells.insert(groups[i].cells.end(), other->cells.begin(), other->cells.end());
    groups.erase(other);
    i = 0;  // its box is larger, and may overlap with those before
  }
}

OutlineTask outline(const CellGroup& group, const PointCells& points, const PlanGrid& grid,
                    double void_size) {
  static auto* const outline =
      reinterpret_cast<OutlineScan*>(load_gis_function(kOutlineScan, "a check without --area"));
  PlanRaster empty(grid);
  empty.fill();
  for (const PlanCell& cell : group.cells)
    for (const Eigen::Vector2d& point : points.cells.at(cell).points)
      clear_disc(grid.to_cells(point), PlanGrid::kCells / 2, empty);
  OutlineTask task{.covered = {.columns = grid.columns,
                               .rows = grid.rows,
                               .row =
                                   [&](std::size_t row, std::span<std::uint8_t> values) {
                                     for (std::size_t column = 0; column < values.size(); ++column)
                                       values[column] = empty.has(column, row) ? 0 : 1;
                                   }},
                   .reach = PlanGrid::kCells / 2,
                   .void_size = void_size / grid.edge()};
  outline(task);
  for (PlanPolygon& polygon : task.polygons)
    for (Ring2& ring : polygon)
      for (Eigen::Vector2d& corner : ring) corner = grid.from_cells(corner);
  return task;
}

}  // namespace

PlanOutline outline_of_points(const ScanFiles& scan, double void_size, Progress& progress) {
  constexpr std::size_t kLeastCells = 8;
  constexpr double kMostCells = 1 << 25, kOfLargest = 0.01;
  PointCells points(progress);
  progress.begin("bounds", scan.expected_points().value_or(0));
  read_all(scan, points);
  std::vector<CellGroup> groups;
  const auto size = [&] { return 2 * kReach * points.edge(); };
  const auto fits = [&] {
    groups = groups_of(points);
    join(groups);
    const double cells = PlanGrid::kCells / size();
    return std::accumulate(groups.begin(), groups.end(), 0.0, [&](double sum, const CellGroup& group) {
             return sum + group.box.volume() * cells * cells;
           }) <= kMostCells;
  };
  while (points.cells.size() >= kLeastCells && !(points.is_area() && fits())) points.coarsen();
  PlanOutline result;
  if (points.cells.size() < kLeastCells) return result;
  double largest = 0;
  std::size_t kept = 0;
  for (const CellGroup& group : groups) {
    kept += group.cells.size();
    OutlineTask task = outline(group, points, PlanGrid::over(group.box, size()), void_size);
    for (const PlanPolygon& polygon : task.polygons) largest = std::max(largest, area_of(polygon));
    result.has_bay = result.has_bay || task.has_bay;
    result.groups.push_back(std::move(task.polygons));
  }
  const std::size_t cells = points.cells.size();
  result.has_dust = static_cast<double>(cells - kept) > kOfLargest * static_cast<double>(cells);
  for (std::vector<PlanPolygon>& polygons : result.groups)
    std::erase_if(polygons, [&](const PlanPolygon& each) { return area_of(each) < kOfLargest * largest; });
  std::erase_if(result.groups, [](const std::vector<PlanPolygon>& polygons) { return polygons.empty(); });
  return result;
}

}  // namespace lacuna::io
