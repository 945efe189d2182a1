// SPDX-License-Identifier: Apache-2.0
// Columns of rows as numbers: one by one, and three together as positions or normals.
#pragma once

#include "io/read/rows/scalar.hpp"

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// A property of all rows, which are `stride` bytes apart.
ConstColumn column_of(const RowBatch& rows, std::size_t stride, const Property& property);
Column column_of(RowBatch& rows, std::size_t stride, const Property& property);

// A value of each row.
void load_column(const RowBatch& rows, std::size_t stride, const Property& property,
                 std::vector<double>& values);

using VectorNames = std::array<const char*, 3>;
inline constexpr VectorNames kPositionNames = {"x", "y", "z"};
inline constexpr VectorNames kNormalNames = {"nx", "ny", "nz"};

// Returns the same columns, packed. The components have this type.
RowLayout with_components_as(Scalar type, const VectorNames& names, const RowLayout& layout);
bool has_vectors(const RowLayout& layout, const VectorNames& names);

// All three columns must exist. `store_vectors` needs them as doubles.
void load_vectors(const RowBatch& rows, const RowLayout& layout, const VectorNames& names,
                  std::vector<Eigen::Vector3d>& vectors);
void store_vectors(std::span<const Eigen::Vector3d> vectors, const RowLayout& layout,
                   const VectorNames& names, RowBatch& rows);

}  // namespace lacuna::io
