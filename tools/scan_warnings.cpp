#include "tools/scan_warnings.hpp"

#include "engine/pipeline.hpp"
#include "engine/run/error.hpp"
#include "engine/run/machine_memory.hpp"
#include "io/crs/crs_text.hpp"
#include "io/crs/stated_crs.hpp"
#include "io/results/points.hpp"
#include "tools/summary.hpp"
#include "tools/visible_text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>

namespace lacuna {
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

std::string file_name(const FileScan& scan, std::size_t i) {
  return visible(scan.files()[i].string());
}

// The first of the files for which it holds.
template <class IsIt>
std::optional<std::size_t> find_file(const FileScan& scan, const IsIt& is_it) {
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    if (is_it(i)) return i;
  }
  return std::nullopt;
}

// How many files after the first one it holds for, as ", and 3 more files" has it.
template <class IsIt>
std::string and_more(const FileScan& scan, std::size_t first, const IsIt& is_it) {
  std::size_t count = 0;
  for (std::size_t i = first + 1; i < scan.files().size(); ++i) count += is_it(i) ? 1 : 0;
  if (count == 0) return "";
  return ", and " + print_count(count) + (count == 1 ? " more file" : " more files");
}

void warn_of_other_systems(const FileScan& scan, std::vector<std::string>& warnings) {
  const auto first = find_file(scan, [&](std::size_t i) { return !scan.crs()[i].empty(); });
  if (!first) return;
  for (std::size_t i = *first; i < scan.files().size(); ++i) {
    if (scan.crs()[i].empty() || is_same_crs(scan.crs()[i], scan.crs()[*first])) continue;
    warnings.push_back(
        file_name(scan, i) +
        ": its coordinate reference system is not that of the first file: " + crs_name(scan.crs()[i]) +
        ", not " + crs_name(scan.crs()[*first]) + "; results name none, unless --crs states it");
  }
}

// A file with a pose is not in its own system, but in that of the others.
void warn_of_missing_systems(const FileScan& scan, std::vector<std::string>& warnings) {
  if (scan.common_crs().empty()) return;
  const auto is_without = [&](std::size_t i) { return scan.crs()[i].empty() && !scan.poses()[i]; };
  const auto first = find_file(scan, is_without);
  if (!first) return;
  warnings.push_back(file_name(scan, *first) + and_more(scan, *first, is_without) +
                     ": without a coordinate reference system; that of the other files holds, " +
                     crs_name(scan.common_crs()));
}

void warn_of_other_units(const FileScan& scan, std::vector<std::string>& warnings) {
  const auto first = find_file(scan, [&](std::size_t i) { return !scan.units()[i].empty(); });
  if (!first || !scan.length_unit().empty()) return;
  const auto is_other = [&](std::size_t i) {
    return !scan.units()[i].empty() && scan.units()[i] != scan.units()[*first];
  };
  if (const auto other = find_file(scan, is_other))
    warnings.push_back(file_name(scan, *other) + and_more(scan, *other, is_other) + ": its unit is " +
                       scan.units()[*other] + ", not " + scan.units()[*first] + " as that of " +
                       file_name(scan, *first) + "; results name none, unless --unit states it");
}

// Where files contradict what the user states of all: `is_other` of a file.
template <class IsOther>
void warn_of_overridden(const FileScan& scan, const std::vector<std::string>& of_files,
                        const IsOther& is_other, const std::string& what, const std::string& stated,
                        std::vector<std::string>& warnings) {
  const auto contradicts = [&](std::size_t i) {
    return !of_files[i].empty() && is_other(of_files[i], stated);
  };
  if (const auto first = find_file(scan, contradicts))
    warnings.push_back(file_name(scan, *first) + and_more(scan, *first, contradicts) + ": its " + what +
                       " is " + crs_name(of_files[*first]) + "; the stated one holds, " + crs_name(stated));
}

}  // namespace

std::string crs_name(const std::string& crs) {
  const std::size_t begin = crs.find('"'), end = crs.find('"', begin + 1);
  return visible(end == crs.npos ? crs : crs.substr(begin + 1, end - begin - 1));
}

void refuse_degrees(const FileScan& scan) {
  constexpr const char* kDegrees = " is in longitude and latitude, and holes need lengths";
  const StatedCrs& stated = scan.stated_crs();
  if (is_geographic(stated.crs))
    throw Error("--crs: " + crs_name(stated.crs) + kDegrees + "; allowed: a projected or geocentric system");
  if (!stated.crs.empty()) return;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    if (!scan.is_geographic(i)) continue;
    const std::string name = scan.crs()[i].empty() ? "its system" : crs_name(scan.crs()[i]);
    throw Error(
        visible(scan.files()[i].string()) + ": " + name + kDegrees +
        "; `pdal translate IN OUT reprojection --filters.reprojection.out_srs=EPSG:N` projects it; if "
        "its coordinates are lengths, --crs can state their system");
  }
}

std::vector<std::string> input_warnings(const FileScan& scan) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    if (is_repeated(scan.files(), i))
      warnings.push_back(file_name(scan, i) + ": given more than once; its points are the same");
  }
  if (scan.stated_crs().crs.empty()) {
    warn_of_other_systems(scan, warnings);
    warn_of_missing_systems(scan, warnings);
  } else {
    warn_of_overridden(scan, scan.crs(), std::not_fn(is_same_crs), "coordinate reference system",
                       scan.stated_crs().crs, warnings);
  }
  if (scan.stated_crs().unit.empty()) {
    warn_of_other_units(scan, warnings);
  } else {
    warn_of_overridden(scan, scan.units(), std::not_equal_to<>(), "unit", scan.stated_crs().unit, warnings);
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

}  // namespace lacuna
