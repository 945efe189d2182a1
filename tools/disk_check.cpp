// SPDX-License-Identifier: Apache-2.0
#include "tools/disk_check.hpp"

#include "engine/run/error.hpp"
#include "engine/run_needs.hpp"
#include "io/results/result_bytes.hpp"
#include "tools/visible_text.hpp"

#include <algorithm>

namespace lacuna::tools {
using namespace io;

namespace {

// Bytes that a disk has to take.
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

}  // namespace

std::vector<std::string> check_disks(const FileScan& scan, const FilesConfig& config,
                                     const std::filesystem::path& workspace, const std::filesystem::path& out,
                                     const FindDisk& find_disk) {
  check_config(config);
  NoProgress silence;
  const Job job(config, workspace, silence);
  const RunSize size = size_from_headers(scan, job);
  const DiskNeeds disk = disk_needs(size, job);
  const ResultBytes bytes = result_bytes(scan, config, size.rows, size.points);

  const std::optional<Disk> of_workspace = find_disk(workspace), of_results = find_disk(out);
  const Needs run{kept_bytes(size), disk.most};
  const Needs results{bytes.certain, bytes.all()};
  std::vector<std::string> warnings;
  if (of_workspace && of_results && of_workspace->number == of_results->number) {
    // The points of the workspace are gone when the results are written.
    const Needs both{std::max(run.certain, results.certain),
                     std::max(run.probable, disk.last + results.probable)};
    check(workspace, of_workspace, both, kOtherScratch, warnings);
  } else {
    check(workspace, of_workspace, run, kOtherScratch, warnings);
    check(out, of_results, results, "; --out names a folder on another one", warnings);
  }
  return warnings;
}

}  // namespace lacuna::tools
