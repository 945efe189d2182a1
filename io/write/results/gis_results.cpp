// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/gis_results.hpp"

#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

namespace lacuna::io {
namespace {

constexpr std::uint64_t kBytesPerCell = 8;

CoverageGrid empty_grid(const Detection& detection, const FilesConfig& config) {
  CoverageGrid grid{.edge = config.output.coverage};
  const Eigen::AlignedBox3d& box = detection.summary.strays.rest;
  if (box.isEmpty()) return grid;
  const Eigen::Array2d low = (box.min().head<2>().array() / grid.edge).floor();
  const Eigen::Array2d high = (box.max().head<2>().array() / grid.edge).floor() + 1;
  const Eigen::Array2d size = high - low;
  const double most = static_cast<double>(Memory::share(config.run.memory_limit).limit / 4 / kBytesPerCell);
  if (!(size.prod() <= most)) {
    throw Error(fmt::format(
        "coverage: cells of {:g} make {:g} x {:g} of them, more than {:g} within the memory limit; "
        "allowed: {:g} or more",
        grid.edge, size.x(), size.y(), most, grid.edge * std::sqrt(size.prod() / most) * 1.01));
  }
  grid.corner = {low.x() * grid.edge, high.y() * grid.edge};
  grid.columns = static_cast<std::size_t>(size.x());
  grid.rows = static_cast<std::size_t>(size.y());
  grid.points.resize(grid.size());
  grid.holes.resize(grid.size());
  return grid;
}

// Points beyond the grid, as strays are, count nowhere.
void count_points(const ScanFiles& scan, CoverageGrid& grid) {
  ScanPass pass(scan);
  for (PointBatch batch; pass.next(batch);) {
    for (const Eigen::Vector3d& p : batch.positions) {
      if (!p.allFinite()) continue;
      const double column = std::floor(p.x() / grid.edge) - std::round(grid.corner.x() / grid.edge);
      const double row = std::round(grid.corner.y() / grid.edge) - 1 - std::floor(p.y() / grid.edge);
      if (column < 0 || row < 0 || column >= static_cast<double>(grid.columns) ||
          row >= static_cast<double>(grid.rows))
        continue;
      ++grid.points[static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column)];
    }
  }
}

// Adds `share` of the cells of a row where [from, to], in cells from the west, covers them.
void add_interval(double from, double to, float share, float* row, std::size_t columns) {
  from = std::max(from, 0.0);
  to = std::min(to, static_cast<double>(columns));
  for (double left = std::floor(from); left < to; ++left) {
    const double overlap = std::min(to, left + 1) - std::max(from, left);
    row[static_cast<std::size_t>(left)] += share * static_cast<float>(overlap);
  }
}

}  // namespace

void add_polygon(const std::vector<Ring2>& rings, CoverageGrid& grid) {
  constexpr int kStrips = 8;
  double north = HUGE_VAL, south = -HUGE_VAL;  // ends of the polygon, in cells below the corner
  std::vector<Ring2> in_cells;
  for (const Ring2& ring : rings) {
    Ring2& corners = in_cells.emplace_back();
    for (const Eigen::Vector2d& p : ring) {
      corners.emplace_back((p.x() - grid.corner.x()) / grid.edge, (grid.corner.y() - p.y()) / grid.edge);
      north = std::min(north, corners.back().y());
      south = std::max(south, corners.back().y());
    }
  }
  const double first = std::max(std::floor(north), 0.0);
  const double last = std::min(std::floor(south), static_cast<double>(grid.rows) - 1);
  std::vector<double> crossings;
  for (double row = first; row <= last; ++row) {
    for (int strip = 0; strip < kStrips; ++strip) {
      const double y = row + (strip + 0.5) / kStrips;
      crossings.clear();
      for (const Ring2& corners : in_cells) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
          if ((a.y() <= y) != (b.y() <= y))
            crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
        }
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
        add_interval(crossings[i], crossings[i + 1], 1.0F / kStrips,
                     grid.holes.data() + static_cast<std::size_t>(row) * grid.columns, grid.columns);
    }
  }
}

CoverageGrid cover(const Detection& detection, const ScanFiles& scan, const FilesConfig& config) {
  CoverageGrid grid = empty_grid(detection, config);
  if (grid.size() == 0) return grid;
  count_points(scan, grid);
  std::vector<Ring2> rings;
  const auto add_ring = [&](std::size_t loop) {
    Ring2& ring = rings.emplace_back();
    detection.for_each_loop_point(loop, [&](const LoopPoint& p) { ring.push_back(p.position().head<2>()); });
  };
  for (std::size_t i = 0; i < detection.loops.size(); ++i) {
    if (detection.loops[i].kind != LoopKind::kHole) continue;
    rings.clear();
    add_ring(i);
    for (const InnerRing& island : detection.inner_rings_of(i)) add_ring(island.loop);
    add_polygon(rings, grid);
  }
  for (float& share : grid.holes) share = std::min(share, 1.0F);
  return grid;
}

namespace {

GisOutput gis_output(const ScanFiles& scan, const OutputFile& out) {
  return {.crs = scan.common_crs(), .name = out.path(), .place = out.place()};
}

// A run gives one warning for all files.
void warn_not_understood(const ScanFiles& scan) {
  static std::once_flag warned;
  std::call_once(warned, [&] {
    spdlog::warn(
        "{}: GDAL does not understand the coordinate reference system of the scan; the files for GIS have "
        "none",
        scan.files().front().name.string());
  });
}

// A GeoJSON without a system is one in longitude and latitude, by RFC 7946.
void warn_of_degrees(const OutputFile& out, const char* reason) {
  spdlog::warn("{}: {}; GIS will read its coordinates, which are those of the scan, as degrees",
               out.path().string(), reason);
}

}  // namespace

void write_loops_gis(const ExplainedDetection& detection, const ScanFiles& scan, const OutputConfig& config,
                     GisFormat format, OutputFile& out) {
  static auto* const write = reinterpret_cast<WriteLoopsGis*>(load_gis_function(kWriteLoopsGis, kGisUser));
  const bool is_geojson = format == GisFormat::kGeoJson;
  GisTask task{.detection = detection,
               .format = format,
               .with_polygons = config.polygons,
               .unit = scan.length_unit(),
               .out = gis_output(scan, out),
               .take = {}};
  if (is_geojson) task.take = [&](std::string_view text) { out.write(text); };
  const GisWritten written = write(task);
  if (written.without_polygon > 0)
    spdlog::warn("{}: loops that have no valid polygon seen from above: {} of {}", out.path().string(),
                 written.without_polygon, detection.loops.size());
  switch (written.crs) {
    case GisCrs::kWritten:
      if (is_geojson && !detection.loops.empty())
        warn_of_accuracy(scan.common_crs(), detection.loops.front().centroid, out.path());
      return;
    case GisCrs::kNone:
      if (is_geojson) warn_of_degrees(out, "no coordinate reference system is known, and --crs can state it");
      return;
    case GisCrs::kNotUnderstood:
      warn_not_understood(scan);
      if (is_geojson) warn_of_degrees(out, "its coordinates are not converted to longitude and latitude");
      return;
    case GisCrs::kNotConverted:
      warn_of_degrees(out,
                      "GDAL cannot convert its coordinate reference system to longitude and latitude there");
  }
}

void write_coverage(const Detection& detection, const ScanFiles& scan, const FilesConfig& config,
                    OutputFile& out) {
  static auto* const write = reinterpret_cast<WriteCoverage*>(load_gis_function(kWriteCoverage, kGisUser));
  const CoverageGrid grid = cover(detection, scan, config);
  if (grid.size() == 0) return;  // GDAL makes no raster without cells
  if (!write(grid, gis_output(scan, out))) warn_not_understood(scan);
}

void write_voids_gpkg(const AreaCheck& check, const ScanFiles& scan, OutputFile& out) {
  static auto* const write = reinterpret_cast<WriteVoidsGis*>(load_gis_function(kWriteVoidsGis, kGisUser));
  if (!write(check, gis_output(scan, out))) warn_not_understood(scan);
}

}  // namespace lacuna::io
