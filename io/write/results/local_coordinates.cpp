// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/local_coordinates.hpp"

#include "io/read/rows/columns.hpp"

#include <cmath>

namespace lacuna::io {

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
