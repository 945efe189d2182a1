#include "tools/scan_warnings.hpp"

#include "engine/pipeline.hpp"
#include "engine/run/machine_memory.hpp"
#include "io/results/points.hpp"
#include "tools/summary.hpp"
#include "tools/visible_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <system_error>

namespace lacuna::tools {
using namespace io;

namespace {

// The distance from the farthest coordinate of single precision to the next one.
double coarsest_step(const Eigen::AlignedBox3d& bounds) {
  const double farthest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  const auto single = static_cast<float>(farthest);
  return static_cast<double>(std::nextafter(single, std::numeric_limits<float>::infinity()) - single);
}

bool is_repeated(const std::vector<std::filesystem::path>& files, std::size_t i) {
  return std::any_of(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(i), [&](const auto& before) {
    std::error_code error;
    return std::filesystem::equivalent(files[i], before, error);
  });
}

}  // namespace

std::string crs_name(const std::string& crs) {
  const std::size_t begin = crs.find('"'), end = crs.find('"', begin + 1);
  return visible(end == crs.npos ? crs : crs.substr(begin + 1, end - begin - 1));
}

std::vector<std::string> input_warnings(const FileScan& scan) {
  std::vector<std::string> warnings;
  const auto warn = [&](std::size_t file, const std::string& reason) {
    warnings.push_back(visible(scan.files()[file].string()) + ": " + reason);
  };
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    if (is_repeated(scan.files(), i)) warn(i, "given more than once; its points are the same");
    const std::string &crs = scan.crs()[i], &first = scan.crs().front();
    if (!crs.empty() && !first.empty() && crs != first)
      warn(i, "its coordinate reference system is not that of the first file: " + crs_name(crs) + ", not " +
                  crs_name(first));
  }
  return warnings;
}

std::vector<std::string> machine_warnings(const FileScan& scan, const Config& config,
                                          const std::filesystem::path& workspace) {
  std::vector<std::string> warnings;
  if (const std::uint64_t memory = machine_memory(); config.run.memory_limit > memory) {
    warnings.push_back("the memory limit of " + print_size(config.run.memory_limit) + " is above the " +
                       print_size(memory) + " of this machine");
  }
  const std::uint64_t needed = least_workspace_bytes(scan, config);
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(workspace, error);
  if (!error && space.available < needed) {
    warnings.push_back(visible(workspace.string()) + ": " + print_size(space.available) +
                       " are free on this disk, and the run needs about " + print_size(needed) +
                       "; --workspace names a folder on another one");
  }
  return warnings;
}

std::vector<std::string> scan_warnings(const FileScan& scan, const Summary& summary, const Config& config) {
  std::vector<std::string> warnings;
  const Counts& counts = summary.counts;
  const std::uint64_t points = counts.points - counts.dropped - counts.thinned_out - counts.duplicates;
  if (points <= static_cast<std::uint64_t>(config.neighbourhood.k)) {
    warnings.push_back(print_count(points) + " different points; each of them has fewer than k = " +
                       std::to_string(config.neighbourhood.k) + " neighbours");
  }
  if (scan.single_precision() && !summary.bounds.isEmpty()) {
    const double step = coarsest_step(summary.bounds);
    if (step > summary.mean_edge_length / 4) {
      std::ostringstream warning;
      warning << "coordinates of single precision are steps of up to " << step << " here, and neighbours are "
              << summary.mean_edge_length
              << " apart; the scan needs double precision, or smaller coordinates";
      warnings.push_back(warning.str());
    }
  }
  // Points of LAS files are finite, so that all of these are from other formats.
  const std::uint64_t not_finite = counts.dropped - scan.filtered_out().total();
  if (config.output.points && not_finite > 0 && points_format(scan, config.output) == PointsFormat::kLas) {
    warnings.push_back("points.las is without the " + print_count(not_finite) +
                       " points that have no finite position, which LAS cannot hold; ids count them");
  }
  return warnings;
}

}  // namespace lacuna::tools
