// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/gis_library.hpp"

#include "io/read/crs/crs.hpp"
#include "io/write/results/coverage_tif.hpp"
#include "io/write/results/voids_gis.hpp"

#include <mutex>

#include <spdlog/spdlog.h>

namespace lacuna::io {
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
