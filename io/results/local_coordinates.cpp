#include "io/results/local_coordinates.hpp"

#include "io/scalar.hpp"
#include "io/vectors.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace lacuna::io {

LocalOffset local_offset(const Detection& detection, const OutputConfig& config) {
  if (!config.local_coordinates) return std::nullopt;
  const Eigen::AlignedBox3d& bounds = detection.summary().strays.rest;
  if (bounds.isEmpty()) return Eigen::Vector3d(0, 0, 0);
  // Added to 0, -0 is 0.
  return bounds.center().unaryExpr([](double middle) { return std::round(middle) + 0.0; });
}

Scalar coordinate_type(const FileScan& scan, const OutputConfig& config) {
  return config.local_coordinates || scan.single_precision() ? Scalar::kFloat32 : Scalar::kFloat64;
}

std::vector<RowLayout> written_layouts(const FileScan& scan, const OutputConfig& config) {
  std::vector<RowLayout> layouts = scan.layouts();
  if (!config.local_coordinates) return layouts;
  for (RowLayout& layout : layouts) {
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const Property& property : layout.properties) {
      const bool is_position = is_component(property.name, kPositionNames);
      columns.emplace_back(property.name, is_position ? Scalar::kFloat32 : property.type);
    }
    layout = packed_layout(columns);
  }
  return layouts;
}

}  // namespace lacuna::io
