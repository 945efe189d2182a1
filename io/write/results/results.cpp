// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/results.hpp"

#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/write/report/report.hpp"
#include "io/write/report/scene.hpp"
#include "io/write/results/gis_results.hpp"

#include <cmath>
#include <functional>
#include <string>

namespace lacuna::io {
namespace {

struct ResultFile {
  std::string name;
  bool is_wanted;
  std::function<void(OutputFile& out)> write;
  Writer writer = Writer::kThis;
};

bool needs_gis_library(const OutputConfig& output) {
  return output.gpkg || output.geojson || output.coverage > 0;
}

std::vector<ResultFile> results_of(const ExplainedDetection& detection, const std::vector<LidMeasures>& lids,
                                   const ScanFiles& scan, const FilesConfig& config) {
  const OutputConfig& output = config.output;
  return {{"loops.ply", true, [&](OutputFile& out) { write_loops(detection, scan, output, out); }},
          {"boundary.ply", true, [&](OutputFile& out) { write_boundary(detection, scan, output, out); }},
          {"sample.ply", config.results.sample_points > 0,
           [&](OutputFile& out) { write_sample(detection, scan, output, out); }},
          {"loops.gpkg", output.gpkg,
           [&](OutputFile& out) { write_loops_gis(detection, scan, output, GisFormat::kGeoPackage, out); },
           Writer::kLibrary},
          {"loops.geojson", output.geojson,
           [&](OutputFile& out) { write_loops_gis(detection, scan, output, GisFormat::kGeoJson, out); }},
          {"lids.ply", output.lids, [&](OutputFile& out) { write_lids(lids, detection, scan, output, out); }},
          {"coverage.tif", output.coverage > 0,
           [&](OutputFile& out) { write_coverage(detection, scan, config, out); }, Writer::kLibrary},
          {"holes.csv", true, [&](OutputFile& out) { write_table(detection, lids, out); }},
          {"run.json", true, [&](OutputFile& out) { write_run(detection, scan, config, out); }},
          {"holes.json", true, [&](OutputFile& out) { write_holes(detection, scan, config, out); }}};
}

}  // namespace

void check_results(const ScanFiles& scan, const FilesConfig& config, const ResultFolder& folder) {
  check_points(scan, config);
  if (needs_gis_library(config.output)) check_gis_module(kGisUser);
  if (config.output.coverage > 0) require_plan(scan, "--coverage");
  check_not_input(folder, scan);
}

std::vector<std::filesystem::path> write_results(const ExplainedDetection& detection, const ScanFiles& scan,
                                                 const FilesConfig& config, ResultFolder& folder) {
  check_results(scan, config, folder);
  const TaskArena arena(static_cast<std::size_t>(config.run.threads));
  std::vector<LidMeasures> lids;
  arena.for_each(1, [&](std::size_t) {
    write_points(detection, scan, config, folder);
    if (config.output.lids) lids = measure_lids(detection);
  });
  const std::vector<ResultFile> results = results_of(detection, lids, scan, config);
  arena.for_each(results.size(), [&](std::size_t i) {
    if (results[i].is_wanted) folder.add(results[i].name, results[i].write, results[i].writer);
  });
  if (config.output.report) {
    folder.add("report.html", [&](OutputFile& out) { write_report(read_scene(folder.staged()), out); });
  }
  scan.check_unchanged();
  return folder.commit();
}

std::vector<std::filesystem::path> write_results(const ExplainedDetection& detection, const ScanFiles& scan,
                                                 const FilesConfig& config,
                                                 const std::filesystem::path& folder) {
  ResultFolder results(folder);
  return write_results(detection, scan, config, results);
}

std::vector<PlyProperty> position_and_id(const Detection& detection, const ScanFiles& scan,
                                         const OutputConfig& config) {
  const Scalar coordinate = coordinate_type(scan, config);
  const bool small = detection.summary.counts.points <= std::numeric_limits<std::uint32_t>::max();
  return {{"x", coordinate, {}},
          {"y", coordinate, {}},
          {"z", coordinate, {}},
          {"scalar_id", small ? Scalar::kUint32 : Scalar::kFloat64, {}}};
}

LocalOffset local_offset(const Detection& detection, const OutputConfig& config) {
  if (!config.local_coordinates) return std::nullopt;
  const Eigen::AlignedBox3d& bounds = detection.summary.strays.rest;
  if (bounds.isEmpty()) return Eigen::Vector3d(0, 0, 0);
  // Added to 0, -0 is 0.
  return bounds.center().unaryExpr([](double middle) { return std::round(middle) + 0.0; });
}

Scalar coordinate_type(const ScanFiles& scan, const OutputConfig& config) {
  return config.local_coordinates || has_single_precision(scan) ? Scalar::kFloat32 : Scalar::kFloat64;
}

std::vector<RowLayout> written_layouts(const ScanFiles& scan, const OutputConfig& config) {
  std::vector<RowLayout> layouts = layouts_of(scan);
  if (!config.local_coordinates) return layouts;
  for (RowLayout& layout : layouts) layout = with_components_as(Scalar::kFloat32, kPositionNames, layout);
  return layouts;
}

}  // namespace lacuna::io
