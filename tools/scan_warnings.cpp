#include "tools/scan_warnings.hpp"

#include "tools/summary.hpp"
#include "tools/visible_text.hpp"

#include <cmath>
#include <limits>
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

}  // namespace

std::vector<std::string> repeated_files(const std::vector<std::filesystem::path>& scans) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::error_code error;  // what cannot be opened is another error, later
      if (!std::filesystem::equivalent(scans[i], scans[j], error)) continue;
      warnings.push_back(visible(scans[i].string()) + ": given more than once; its points are the same");
      break;
    }
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
  return warnings;
}

}  // namespace lacuna
