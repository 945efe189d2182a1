// SPDX-License-Identifier: Apache-2.0
// The area that is checked: the polygons of its files, and the cells over it.
#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"
#include "engine/run/memory.hpp"
#include "io/explain/area/area_polygons.hpp"
#include "io/explain/area/check_area.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <system_error>
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

Area read_area_files(const ScanFiles& scan, const FilesConfig& config, double void_size) {
  require_plan(scan, config.area.area.empty() ? "check" : "--area");
  Area area;
  PolygonFiles files(scan, config, void_size);
  if (!config.area.area.empty()) area.polygons = files.read(config.area.area);
  if (!config.area.except.empty()) area.exceptions = files.read(config.area.except);
  area.off = files.off();
  area.classes = read_classes(config.area.classes, files);
  area.bytes = files.bytes();
  return area;
}

double tile_edge_of(const FilesConfig& config, double void_size, const Eigen::AlignedBox2d& bounds) {
  constexpr double kAlongMap = 50;
  if (config.area.area_tile > 0 || !config.output.report) return config.area.area_tile;
  const double least = std::max(void_size, bounds.sizes().maxCoeff() / kAlongMap);
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double edge : {power, 2 * power, 5 * power})
    if (edge >= least) return edge;
  return 10 * power;
}

}  // namespace lacuna::io
