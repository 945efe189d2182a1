// SPDX-License-Identifier: Apache-2.0
#include "io/results/result_bytes.hpp"

#include "io/results/points.hpp"
#include "io/results/results.hpp"

#include <algorithm>

namespace lacuna::io {

ResultBytes result_bytes(const FileScan& scan, const FilesConfig& config, std::uint64_t rows,
                         std::uint64_t points, const Eigen::AlignedBox3d& bounds) {
  constexpr std::uint64_t kPage = 200'000, kReportPoint = 15, kMostInReport = 1'000'000;
  const OutputConfig& output = config.output;
  const std::uint64_t sample = std::min(points, static_cast<std::uint64_t>(config.results.sample_points));
  ResultBytes bytes;
  if (config.results.points) {
    const PointsBytes annotated = points_bytes(scan, output, rows);
    bytes.points = annotated.all;
    bytes.certain = annotated.certain;
  }
  bytes.sample = sample * sample_row_bytes(scan, output);
  if (output.report) bytes.report = kPage + std::min(sample, kMostInReport) * kReportPoint;
  if (output.coverage > 0 && !bounds.isEmpty()) {
    constexpr double kCell = 12, kMost = 1e18;  // three bands of floats; a run refuses rasters that large
    const Eigen::Array2d cells = (bounds.sizes().head<2>().array() / output.coverage).ceil() + 1;
    bytes.raster = static_cast<std::uint64_t>(std::min(cells.prod() * kCell, kMost));
  }
  return bytes;
}

}  // namespace lacuna::io
