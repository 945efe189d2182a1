// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/columns.hpp"

#include "io/read/files/number.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

namespace lacuna::io {
namespace {

struct Names {
  const char* name;
  std::string_view other;
};

// Names are in the order of `Scalar`.
constexpr std::array<Names, 8> kNames = {{{"char", "int8"},
                                          {"uchar", "uint8"},
                                          {"short", "int16"},
                                          {"ushort", "uint16"},
                                          {"int", "int32"},
                                          {"uint", "uint32"},
                                          {"float", "float32"},
                                          {"double", "float64"}}};

}  // namespace

std::size_t size_of(Scalar type) {
  return with_type(type, [](auto value) { return sizeof(value); });
}

const char* ply_name(Scalar type) {
  return kNames[static_cast<std::size_t>(type)].name;
}

std::optional<Scalar> scalar_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i].name || name == kNames[i].other) return static_cast<Scalar>(i);
  }
  return name == "bool" ? std::optional(Scalar::kUint8) : std::nullopt;
}

bool is_integer(Scalar type) {
  return type != Scalar::kFloat32 && type != Scalar::kFloat64;
}

void copy_column(ConstColumn from, Column to, std::size_t count) {
  assert(from.type == to.type || to.type == Scalar::kFloat64);
  with_type(from.type, [&](auto zero) {
    const bool same = from.type == to.type;
    for (std::size_t i = 0; i < count; ++i, from.data += from.stride) {
      const auto value = load<decltype(zero)>(from.data);
      if (same) {
        store(to.data + i * to.stride, value);
      } else {
        store(to.data + i * to.stride, static_cast<double>(value));
      }
    }
  });
}

float nearest_float(double value) {
  using Limits = std::numeric_limits<float>;
  if (std::abs(value) > static_cast<double>(Limits::max()))
    return value > 0 ? Limits::infinity() : -Limits::infinity();
  return static_cast<float>(value);
}

void put_floating(std::byte* to, Scalar type, double value) {
  assert(!is_integer(type));
  if (type == Scalar::kFloat32) {
    store(to, nearest_float(value));
  } else {
    store(to, value);
  }
}

void copy_column(ConstColumn from, std::optional<double> summand, Column to, std::size_t count) {
  if (!summand) return copy_column(from, to, count);
  with_type(from.type, [&](auto zero) {
    for (std::size_t i = 0; i < count; ++i, from.data += from.stride) {
      const auto value = static_cast<double>(load<decltype(zero)>(from.data));
      put_floating(to.data + i * to.stride, to.type, value + *summand);
    }
  });
}

void fill_missing(Column to, std::size_t count) {
  with_type(to.type, [&](auto value) {
    using T = decltype(value);
    if constexpr (std::is_floating_point_v<T>) value = std::numeric_limits<T>::quiet_NaN();
    for (std::size_t i = 0; i < count; ++i) store(to.data + i * to.stride, value);
  });
}

void swap_bytes(Column column, std::size_t count) {
  with_type(column.type, [&](auto value) {
    std::array<std::byte, sizeof(value)> bytes;
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(bytes.data(), column.data + i * column.stride, sizeof(value));
      std::reverse(bytes.begin(), bytes.end());
      std::memcpy(column.data + i * column.stride, bytes.data(), sizeof(value));
    }
  });
}

RowLayout packed_layout(std::span<const std::pair<std::string, Scalar>> properties) {
  RowLayout layout;
  for (const auto& [name, type] : properties) {
    layout.properties.push_back({.name = name, .type = type, .offset = layout.stride});
    layout.stride += size_of(type);
  }
  return layout;
}

const Property* RowLayout::find(std::string_view name) const {
  for (const Property& property : properties) {
    if (property.name == name) return &property;
  }
  return nullptr;
}

std::vector<const Property*> RowLayout::all_alike(std::string_view name) const {
  if (const Property* const exact = find(name)) return {exact};
  std::vector<const Property*> alike;
  for (const Property& property : properties) {
    if (bare_name(property.name) == bare_name(name)) alike.push_back(&property);
  }
  return alike;
}

const Property* RowLayout::find_alike(std::string_view name) const {
  const std::vector<const Property*> alike = all_alike(name);
  return alike.empty() ? nullptr : alike.front();
}

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
