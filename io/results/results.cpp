// SPDX-License-Identifier: Apache-2.0
#include "io/results/results.hpp"

#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "io/crs/gis_module.hpp"
#include "io/report/report.hpp"
#include "io/report/scene.hpp"
#include "io/results/gis_library.hpp"
#include "io/results/lids.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/points.hpp"
#include "io/results/voids.hpp"
#include "io/scan/plan_system.hpp"
#include "io/scan/scan_identity.hpp"

#include <functional>
#include <limits>
#include <string>

namespace lacuna::io {
namespace {

struct ResultFile {
  std::string name;
  bool is_wanted;
  std::function<void(OutputFile& out)> write;
  Writer writer = Writer::kThis;
};

bool has_area(const FilesConfig& config) {
  return !config.area.area.empty();
}

bool needs_gis_library(const FilesConfig& config) {
  return config.output.gpkg || config.output.geojson || config.output.coverage > 0 || has_area(config);
}

std::vector<ResultFile> results_of(const ExplainedDetection& detection, const ScanFiles& scan,
                                   const FilesConfig& config) {
  const OutputConfig& output = config.output;
  return {{"loops.ply", true, [&](OutputFile& out) { write_loops(detection, scan, output, out); }},
          {"boundary.ply", true, [&](OutputFile& out) { write_boundary(detection, scan, output, out); }},
          {"sample.ply", config.results.sample_points > 0,
           [&](OutputFile& out) { write_sample(detection, scan, output, out); }},
          {"loops.obj", output.obj, [&](OutputFile& out) { write_loops_obj(detection, out); }},
          {"loops.gpkg", output.gpkg,
           [&](OutputFile& out) { write_loops_gis(detection, scan, output, GisFormat::kGeoPackage, out); },
           Writer::kLibrary},
          {"loops.geojson", output.geojson,
           [&](OutputFile& out) { write_loops_gis(detection, scan, output, GisFormat::kGeoJson, out); }},
          {"lids.obj", output.lids, [&](OutputFile& out) { write_lids_obj(detection, out); }},
          {"coverage.tif", output.coverage > 0,
           [&](OutputFile& out) { write_coverage(detection, scan, config, out); }, Writer::kLibrary},
          {"holes.csv", true, [&](OutputFile& out) { write_table(detection, out); }},
          {"run.json", true, [&](OutputFile& out) { write_run(detection, scan, config, out); }},
          {"holes.json", true, [&](OutputFile& out) { write_holes(detection, scan, config, out); }}};
}

// Results that are made of other ones, which are complete. `folder`: where these are.
std::vector<ResultFile> results_of_results(const Detection& detection, const ScanFiles& scan,
                                           const OutputConfig& output, const std::filesystem::path& folder) {
  const std::filesystem::path lids = folder / "lids.obj";
  return {
      {"lids.ply", output.lids,
       [&, lids](OutputFile& out) { write_lids_ply(lids, detection, scan, output, out); }},
      {"lids.csv", output.lids, [lids](OutputFile& out) { write_lids_table(lids, out); }},
      {"report.html", output.report, [folder](OutputFile& out) { write_report(read_scene(folder), out); }}};
}

}  // namespace

void check_results(const ScanFiles& scan, const FilesConfig& config, const ResultFolder& folder) {
  check_points(scan, config);
  if (needs_gis_library(config)) check_gis_module(kGisUser);
  if (config.output.coverage > 0) require_plan(scan, "--coverage");
  check_not_input(folder, scan);
}

std::vector<std::filesystem::path> write_results(const ExplainedDetection& detection, const ScanFiles& scan,
                                                 const FilesConfig& config, ResultFolder& folder) {
  check_results(scan, config, folder);
  if (has_area(config) && !detection.area)
    throw Error(config.area.area + ": the area was not checked; io::check_area does it");

  const TaskArena arena(static_cast<std::size_t>(config.run.threads));
  arena.for_each(1, [&](std::size_t) { write_points(detection, scan, config, folder); });
  if (has_area(config)) add_voids(*detection.area, scan, config.area, folder);
  const std::vector<ResultFile> results = results_of(detection, scan, config);
  const auto write = [&](const ResultFile& file) {
    if (file.is_wanted) folder.add(file.name, file.write, file.writer);
  };
  arena.for_each(results.size(), [&](std::size_t i) { write(results[i]); });
  for (const ResultFile& file : results_of_results(detection, scan, config.output, folder.staged()))
    write(file);
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

}  // namespace lacuna::io
