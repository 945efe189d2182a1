// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/vectors.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace lacuna::io {

ConstColumn column_of(const RowBatch& rows, std::size_t stride, const Property& property) {
  return {rows.bytes.data() + property.offset, static_cast<std::ptrdiff_t>(stride), property.type};
}

Column column_of(RowBatch& rows, std::size_t stride, const Property& property) {
  return {rows.bytes.data() + property.offset, stride, property.type};
}

void load_column(const RowBatch& rows, std::size_t stride, const Property& property,
                 std::vector<double>& values) {
  values.resize(rows.count);
  copy_column(column_of(rows, stride, property),
              {.data = reinterpret_cast<std::byte*>(values.data()),
               .stride = sizeof(double),
               .type = Scalar::kFloat64},
              rows.count);
}

RowLayout with_components_as(Scalar type, const VectorNames& names, const RowLayout& layout) {
  std::vector<std::pair<std::string, Scalar>> columns;
  for (const Property& property : layout.properties) {
    const bool is_component = std::find(names.begin(), names.end(), property.name) != names.end();
    columns.emplace_back(property.name, is_component ? type : property.type);
  }
  return packed_layout(columns);
}

bool has_vectors(const RowLayout& layout, const VectorNames& names) {
  return std::all_of(names.begin(), names.end(), [&](const char* name) { return layout.find(name); });
}

void load_vectors(const RowBatch& rows, const RowLayout& layout, const VectorNames& names,
                  std::vector<Eigen::Vector3d>& vectors) {
  vectors.resize(rows.count);
  if (rows.count == 0) return;
  auto* to = reinterpret_cast<std::byte*>(vectors.data());
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    copy_column(
        column_of(rows, layout.stride, *layout.find(names[axis])),
        {.data = to + axis * sizeof(double), .stride = sizeof(Eigen::Vector3d), .type = Scalar::kFloat64},
        rows.count);
  }
}

void store_vectors(std::span<const Eigen::Vector3d> vectors, const RowLayout& layout,
                   const VectorNames& names, RowBatch& rows) {
  if (vectors.empty()) return;
  const auto* from = reinterpret_cast<const std::byte*>(vectors.data());
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    copy_column(
        {.data = from + axis * sizeof(double), .stride = sizeof(Eigen::Vector3d), .type = Scalar::kFloat64},
        column_of(rows, layout.stride, *layout.find(names[axis])), vectors.size());
  }
}

}  // namespace lacuna::io
