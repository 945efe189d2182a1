#include "io/results.hpp"

#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "io/ply_writer.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

namespace lacuna {
namespace {

struct ResultFile {
  std::string_view name;
  std::string_view mark;
  void (*write)(const Detection&, const FileScan&, const Config&, OutputFile&);
};

using D = const Detection&;
using S = const FileScan&;
using C = const Config&;
constexpr ResultFile kPoints{"points.ply", kPlyMark,
                             [](D d, S s, C c, OutputFile& out) { write_points(d, s, c.output, out); }};
// In the order in which they appear: the report comes last, and stands for all the others.
constexpr ResultFile kResults[] = {
    {"loops.ply", kPlyMark, [](D d, S s, C, OutputFile& out) { write_loops(d, s, out); }},
    {"boundary.ply", kPlyMark, [](D d, S s, C, OutputFile& out) { write_boundary(d, s, out); }},
    kPoints,
    {"holes.json", kReportMark, write_report}};

std::vector<ResultFile> results_of(const Config& config) {
  std::vector<ResultFile> results;
  std::copy_if(std::begin(kResults), std::end(kResults), std::back_inserter(results),
               [&](const ResultFile& result) { return result.name != kPoints.name || config.output.points; });
  return results;
}

void check_not_input(const std::filesystem::path& file, const FileScan& scan) {
  for (const auto& input : scan.files()) {
    std::error_code error;  // where nothing is, nothing can be lost
    if (std::filesystem::equivalent(file, input, error)) {
      throw Error(input.string() + ": is an input in the place of a result; another output folder is needed");
    }
  }
}

}  // namespace

std::vector<std::filesystem::path> result_files(const Config& config, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const ResultFile& result : results_of(config)) files.push_back(folder / result.name);
  return files;
}

void check_output_folder(const FileScan& scan, const Config& config, const std::filesystem::path& folder,
                         Overwrite overwrite) {
  for (const ResultFile& result : results_of(config)) {
    check_not_input(folder / result.name, scan);
    check_output(folder / result.name, result.mark, overwrite);
  }
  if (is_own_file(folder / kPoints.name, kPoints.mark)) check_not_input(folder / kPoints.name, scan);
}

void write_results(const Detection& detection, const FileScan& scan, const Config& config,
                   const std::filesystem::path& folder, Overwrite overwrite) {
  check_output_folder(scan, config, folder, overwrite);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": the folder cannot be made: " + error.message());

  OutputSet set(overwrite);
  const std::vector<ResultFile> results = results_of(config);
  std::vector<OutputFile*> files;
  for (const ResultFile& result : results) files.push_back(&set.add(folder / result.name, result.mark));
  if (!config.output.points) set.drop(folder / kPoints.name, kPoints.mark);
  const TaskArena arena(static_cast<std::size_t>(config.run.threads));
  arena.for_each(results.size(), [&](std::size_t i) { results[i].write(detection, scan, config, *files[i]); });
  scan.check_unchanged();
  set.commit();
}

std::vector<PlyProperty> position_and_id(const Detection& detection, const FileScan& scan) {
  const Scalar coordinate = scan.single_precision() ? Scalar::kFloat32 : Scalar::kFloat64;
  const bool small = detection.summary().counts.points <= std::numeric_limits<std::uint32_t>::max();
  return {{"x", coordinate, {}},
          {"y", coordinate, {}},
          {"z", coordinate, {}},
          {"id", small ? Scalar::kUint32 : Scalar::kFloat64, {}}};
}

}  // namespace lacuna
