// SPDX-License-Identifier: Apache-2.0
#include "io/results/results.hpp"

#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "io/ply/ply_writer.hpp"
#include "io/report/report.hpp"
#include "io/report/scene.hpp"
#include "io/results/gis_library.hpp"
#include "io/results/lids.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/loops_obj.hpp"
#include "io/results/points.hpp"
#include "io/results/voids.hpp"
#include "io/scan/plan_system.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

namespace lacuna::io {
namespace {

struct ResultFile {
  std::string_view name;
  void (*write)(const ExplainedDetection&, const FileScan&, const FilesConfig&, OutputFile&);
  bool (*is_wanted)(const FilesConfig&);
  Writer writer = Writer::kThis;
  bool is_of_others = false;  // made of the other results, once these are complete
};

using D = const ExplainedDetection&;
using S = const FileScan&;
using C = const FilesConfig&;
bool always(C) {
  return true;
}

bool has_lids(C config) {
  return config.output.lids;
}

bool has_area(C config) {
  return !config.area.area.empty();
}

// The complete lids.obj of the same run.
std::filesystem::path lids_obj(const OutputFile& out) {
  return out.place().parent_path() / "lids.obj";
}

bool needs_gis_library(const FilesConfig& config) {
  return config.output.gpkg || config.output.geojson || config.output.coverage > 0 || has_area(config);
}

const std::vector<ResultFile>& all_results() {
  static const std::vector<ResultFile> results = {
      {"loops.ply", [](D d, S s, C c, OutputFile& out) { write_loops(d, s, c.output, out); }, always},
      {"boundary.ply", [](D d, S s, C c, OutputFile& out) { write_boundary(d, s, c.output, out); }, always},
      {"sample.ply", [](D d, S s, C c, OutputFile& out) { write_sample(d, s, c.output, out); },
       [](C c) { return c.results.sample_points > 0; }},
      {"loops.obj", [](D d, S, C, OutputFile& out) { write_loops_obj(d, out); },
       [](C c) { return c.output.obj; }},
      {"loops.gpkg",
       [](D d, S s, C c, OutputFile& out) { write_loops_gis(d, s, c.output, GisFormat::kGeoPackage, out); },
       [](C c) { return c.output.gpkg; }, Writer::kLibrary},
      {"loops.geojson",
       [](D d, S s, C c, OutputFile& out) { write_loops_gis(d, s, c.output, GisFormat::kGeoJson, out); },
       [](C c) { return c.output.geojson; }},
      {"lids.obj", [](D d, S, C, OutputFile& out) { write_lids_obj(d, out); }, has_lids},
      {"lids.ply", [](D d, S s, C c, OutputFile& out) { write_lids_ply(lids_obj(out), d, s, c.output, out); },
       has_lids, Writer::kThis, true},
      {"lids.csv", [](D, S, C, OutputFile& out) { write_lids_table(lids_obj(out), out); }, has_lids,
       Writer::kThis, true},
      {"coverage.tif", [](D d, S s, C c, OutputFile& out) { write_coverage(d, s, c, out); },
       [](C c) { return c.output.coverage > 0; }, Writer::kLibrary},
      {"voids.gpkg", [](D d, S s, C, OutputFile& out) { write_voids_gpkg(*d.area, s, out); }, has_area,
       Writer::kLibrary},
      {"voids.csv", [](D d, S, C, OutputFile& out) { write_voids_table(*d.area, out); }, has_area},
      {kVoidsFile, [](D d, S s, C c, OutputFile& out) { write_voids_json(*d.area, s, c.area, out); },
       has_area},
      {"report.html",
       [](D, S, C, OutputFile& out) { write_report(read_scene(out.place().parent_path()), out); },
       [](C c) { return c.output.report; }, Writer::kThis, true},
      {"holes.csv", [](D d, S, C, OutputFile& out) { write_table(d, out); }, always},
      {"run.json", [](D d, S s, C c, OutputFile& out) { write_run(d, s, c, out); }, always},
      {"holes.json", write_holes, always}};
  return results;
}

std::vector<ResultFile> results_of(const FilesConfig& config) {
  std::vector<ResultFile> results;
  std::copy_if(all_results().begin(), all_results().end(), std::back_inserter(results),
               [&](const ResultFile& result) { return result.is_wanted(config); });
  return results;
}

}  // namespace

void check_results(const FileScan& scan, const FilesConfig& config, const ResultFolder& folder) {
  check_points(scan, config);
  if (needs_gis_library(config)) check_gis_library();
  if (config.output.coverage > 0) require_plan(scan, "--coverage");
  check_not_input(folder, scan);
}

std::vector<std::filesystem::path> write_results(const ExplainedDetection& detection, const FileScan& scan,
                                                 const FilesConfig& config, ResultFolder& folder) {
  check_results(scan, config, folder);
  if (has_area(config) && !detection.area)
    throw Error(config.area.area + ": the area was not checked; io::check_area does it");

  const TaskArena arena(static_cast<std::size_t>(config.run.threads));
  arena.for_each(1, [&](std::size_t) { write_points(detection, scan, config, folder); });
  const std::vector<ResultFile> results = results_of(config);
  const auto write = [&](std::size_t i) {
    const auto file = folder.open(std::string(results[i].name), results[i].writer);
    results[i].write(detection, scan, config, *file);
    file->close();
  };
  arena.for_each(results.size(), [&](std::size_t i) {
    if (!results[i].is_of_others) write(i);
  });
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].is_of_others) write(i);
  }
  scan.check_unchanged();
  return folder.commit();
}

std::vector<std::filesystem::path> write_results(const ExplainedDetection& detection, const FileScan& scan,
                                                 const FilesConfig& config,
                                                 const std::filesystem::path& folder) {
  ResultFolder results(folder);
  return write_results(detection, scan, config, results);
}

std::vector<PlyProperty> position_and_id(const Detection& detection, const FileScan& scan,
                                         const OutputConfig& config) {
  const Scalar coordinate = coordinate_type(scan, config);
  const bool small = detection.summary.counts.points <= std::numeric_limits<std::uint32_t>::max();
  return {{"x", coordinate, {}},
          {"y", coordinate, {}},
          {"z", coordinate, {}},
          {"scalar_id", small ? Scalar::kUint32 : Scalar::kFloat64, {}}};
}

}  // namespace lacuna::io
