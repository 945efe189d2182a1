// SPDX-License-Identifier: Apache-2.0
#include "io/read/pcd/pcd_fields.hpp"

#include "io/read/files/little_endian.hpp"
#include "io/read/files/property_name.hpp"
#include "io/read/rows/scalar.hpp"

#include <array>
#include <bit>
#include <set>
#include <utility>

namespace lacuna::io {
namespace {

// The type of its properties.
Scalar scalar_of(const PcdField& field) {
  if (field.size == 8) return Scalar::kFloat64;
  if (field.type == 'F') return Scalar::kFloat32;
  constexpr std::array kSigned = {Scalar::kInt8, Scalar::kInt16, Scalar::kInt32};
  constexpr std::array kUnsigned = {Scalar::kUint8, Scalar::kUint16, Scalar::kUint32};
  const std::size_t rank = std::countr_zero(field.size);
  return field.type == 'I' ? kSigned[rank] : kUnsigned[rank];
}

// Colours as bytes of one value: blue is the lowest, alpha the highest.
bool is_packed_colour(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

std::string name_of(const PcdField& field) {
  for (const auto& [given, name] :
       {std::pair{"normal_x", "nx"}, std::pair{"normal_y", "ny"}, std::pair{"normal_z", "nz"}}) {
    if (field.name == given) return name;
  }
  return property_name(field.name);
}

// Copies one field of `count` rows, from rows as they are in the file to rows of properties.
void convert(const PcdField& field, ConstColumn from, std::byte* to, std::size_t to_stride,
             std::size_t count) {
  if (is_packed_colour(field)) {
    const std::size_t channels = field.name == "rgba" ? 4 : 3;
    constexpr std::array kShift = {16, 8, 0, 24};  // red, green, blue, alpha
    for (std::size_t row = 0; row < count; ++row, from.data += from.stride) {
      const auto packed = load<std::uint32_t>(from.data);
      for (std::size_t i = 0; i < channels; ++i) {
        to[row * to_stride + i] = static_cast<std::byte>(packed >> kShift[i]);
      }
    }
    return;
  }
  const std::size_t to_size = size_of(scalar_of(field));
  for (std::size_t i = 0; i < field.count; ++i) {
    const std::byte* values = from.data + i * field.size;
    if (field.size == 8 && field.type != 'F') {
      with_pcd_type(field, [&](auto value) {
        for (std::size_t row = 0; row < count; ++row, values += from.stride)
          store(to + i * to_size + row * to_stride, static_cast<double>(load<decltype(value)>(values)));
      });
    } else {
      copy_column({.data = values, .stride = from.stride, .type = scalar_of(field)},
                  {.data = to + i * to_size, .stride = to_stride, .type = scalar_of(field)}, count);
    }
  }
}

std::size_t converted_bytes(const PcdField& field) {
  if (field.is_padding()) return 0;
  if (is_packed_colour(field)) return field.name == "rgba" ? 4 : 3;
  return size_of(scalar_of(field)) * field.count;
}

}  // namespace

RowLayout pcd_layout(const InputFile& in, const PcdHeader& header) {
  std::vector<std::pair<std::string, Scalar>> properties;
  for (const PcdField& field : header.fields) {
    if (field.is_padding()) continue;
    if (is_packed_colour(field)) {
      for (const char* name : {"red", "green", "blue"}) properties.emplace_back(name, Scalar::kUint8);
      if (field.name == "rgba") properties.emplace_back("alpha", Scalar::kUint8);
    } else if (field.count == 1) {
      properties.emplace_back(name_of(field), scalar_of(field));
    } else {
      for (std::size_t i = 0; i < field.count; ++i) {
        properties.emplace_back(name_of(field) + '_' + std::to_string(i), scalar_of(field));
      }
    }
  }
  std::set<std::string_view> names;
  for (const auto& [name, type] : properties) {
    if (!names.insert(name).second) {
      in.fail_at_line(in.line(), "two fields have the name " + in_quotes(name) + "; names must differ");
    }
  }
  for (const char* name : {"x", "y", "z"}) {
    if (!names.contains(name)) {
      in.fail_at_line(in.line(),
                      "no field " + in_quotes(name) + " with one value a point; x, y and z are needed");
    }
  }
  return packed_layout(properties);
}

void convert_pcd_rows(const PcdHeader& header, const std::byte* raw, const RowLayout& layout,
                      RowBatch& batch) {
  const auto stride = static_cast<std::ptrdiff_t>(header.row_bytes());
  std::size_t from = 0, to = 0;
  for (const PcdField& field : header.fields) {
    if (!field.is_padding()) {
      convert(field, {.data = raw + from, .stride = stride, .type = scalar_of(field)},
              batch.bytes.data() + to, layout.stride, batch.count);
    }
    from += field.bytes();
    to += converted_bytes(field);
  }
}

}  // namespace lacuna::io
