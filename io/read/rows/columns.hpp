// SPDX-License-Identifier: Apache-2.0
// Columns of rows: scalars whose type is known only at run time, and three of them together as positions or
// normals.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// Functions for a `Scalar` that is known only at run time.

// Accepts both spellings of the PLY format, "char" and "int8", and so on. "bool" is a byte.
std::optional<Scalar> scalar_from_name(std::string_view name);

bool is_integer(Scalar type);

// Calls `visit(T{})` with the C++ type that `type` stands for.
template <class Visit>
decltype(auto) with_type(Scalar type, Visit&& visit) {
  switch (type) {
    case Scalar::kInt8:
      return visit(std::int8_t{});
    case Scalar::kUint8:
      return visit(std::uint8_t{});
    case Scalar::kInt16:
      return visit(std::int16_t{});
    case Scalar::kUint16:
      return visit(std::uint16_t{});
    case Scalar::kInt32:
      return visit(std::int32_t{});
    case Scalar::kUint32:
      return visit(std::uint32_t{});
    case Scalar::kFloat32:
      return visit(float{});
    case Scalar::kFloat64:
      break;
  }
  return visit(double{});
}

// A column of rows: `count` values, the first at `data`, each `stride` bytes after the one before.
struct ConstColumn {
  const std::byte* data;
  std::ptrdiff_t stride;
  Scalar type;
};
struct Column {
  std::byte* data;
  std::size_t stride;
  Scalar type;
};

// Copies `count` values. The types are equal, or `to` is kFloat64, which holds every other exactly.
void copy_column(ConstColumn from, Column to, std::size_t count);

// Returns the nearest float; infinite if the value is too large for one.
float nearest_float(double value);

// Puts a value to where a kFloat32 or kFloat64 lies.
void put_floating(std::byte* to, Scalar type, double value);

// Does the same with `summand` added in double precision, if there is one. Then `to` is kFloat32 or kFloat64.
void copy_column(ConstColumn from, std::optional<double> summand, Column to, std::size_t count);

// Puts NaN into a column of floats, 0 into one of integers.
void fill_missing(Column to, std::size_t count);

// Reverses the bytes of every value, from big to little endian and back.
void swap_bytes(Column column, std::size_t count);

// Lays the properties one after the other without padding.
RowLayout packed_layout(std::span<const std::pair<std::string, Scalar>> properties);

// Columns of rows as numbers: one by one, and three together as positions or normals.

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
