// SPDX-License-Identifier: Apache-2.0
#include "tools/run/disk_check.hpp"

#include "engine/run/error.hpp"
#include "engine/run/job.hpp"
#include "io/results/result_bytes.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/run/run_costs.hpp"

#include <algorithm>

namespace lacuna::tools {
using namespace io;

namespace {

// The bytes that a disk has to take.
struct Needs {
  std::uint64_t certain = 0, probable = 0;
};

void check(const std::filesystem::path& folder, const std::optional<Disk>& disk, const Needs& needs,
           const std::string& way_out, std::vector<std::string>& warnings) {
  if (!disk) return;
  const std::string name = visible(folder.string());
  if (disk->free < needs.certain)
    throw Error(too_small(name, *disk, "at least " + print_size(needs.certain)) + way_out);
  if (disk->free < needs.probable)
    warnings.push_back(too_small(name, *disk, "about " + print_size(needs.probable)) + way_out);
}

// Whether the headers say how many points take part.
bool takes_all_points(const InputConfig& input, const ScaleConfig& scale) {
  return first_edge(scale) == 0 && input.bounds.empty() && input.leave_out.empty() && !input.drop_origin &&
         input.where.empty();
}

}  // namespace

std::vector<std::string> check_disks(const FileScan& scan, const FilesConfig& config,
                                     const std::filesystem::path& workspace, const std::filesystem::path& out,
                                     const FindDisk& find_disk) {
  check_config(config);
  constexpr std::uint64_t kMostRows = std::uint64_t{1} << 53;  // a broken header may have more
  const std::uint64_t rows = std::min(scan.expected_points().value_or(0), kMostRows);
  const bool takes_all = takes_all_points(config.input, config.scale);
  const std::uint64_t points = first_edge(config.scale) > 0 ? 0 : rows;
  NoProgress silence;
  if (takes_all)
    Job(config, workspace, silence).tile_points(points);  // throws where memory can never suffice
  const RunCosts costs = run_costs(scan, config, rows, points);
  const ResultBytes bytes = result_bytes(scan, config, rows, points);

  const Needs run{takes_all ? costs.least_disk : 0, costs.disk}, results{bytes.certain, bytes.all()};
  const std::optional<Disk> of_workspace = find_disk(workspace), of_results = find_disk(out);
  std::vector<std::string> warnings;
  if (of_workspace && of_results && of_workspace->number == of_results->number) {
    // Some temporary files are still there while the results are written.
    const Needs both{std::max(run.certain, results.certain), run.probable + results.probable};
    check(workspace, of_workspace, both, kOtherScratch, warnings);
  } else {
    check(workspace, of_workspace, run, kOtherScratch, warnings);
    check(out, of_results, results, "; --out names a folder on another one", warnings);
  }
  return warnings;
}

}  // namespace lacuna::tools
