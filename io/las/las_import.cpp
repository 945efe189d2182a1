// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_import.hpp"

#include "engine/run/error.hpp"
#include "io/little_endian.hpp"
#include "io/scalar.hpp"
#include "io/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <type_traits>

namespace lacuna::io {
namespace {

double load_double(Scalar type, const std::byte* from) {
  return with_type(type, [&](auto zero) { return static_cast<double>(load<decltype(zero)>(from)); });
}

std::array<Property, 3> position_of(const RowLayout& layout) {
  std::array<Property, 3> position;
  for (std::size_t axis = 0; axis < 3; ++axis) position[axis] = *layout.find(kPositionNames[axis]);
  return position;
}

Eigen::Vector3d load_position(const std::array<Property, 3>& position, const std::byte* row) {
  Eigen::Vector3d loaded;
  for (std::size_t axis = 0; axis < 3; ++axis)
    loaded[static_cast<Eigen::Index>(axis)] = load_double(position[axis].type, row + position[axis].offset);
  return loaded;
}

// Whole numbers that fit, as the survey has found.
void put_field(const ImportedField& imported, const RowLayout& layout, std::span<const std::byte> rows,
               std::size_t stride, std::byte* out) {
  const LasField& field = *imported.field;
  for (const std::byte* row = rows.data(); row != rows.data() + rows.size();
       row += layout.stride, out += stride) {
    const double value = load_double(imported.from.type, row + imported.from.offset) * imported.factor;
    if (field.bits > 0) {
      out[field.offset] |= static_cast<std::byte>(static_cast<unsigned>(value) << field.shift);
    } else {
      with_type(field.type,
                [&](auto zero) { store(out + field.offset, static_cast<decltype(zero)>(value)); });
    }
  }
}

}  // namespace

ImportSurvey::ImportSurvey(const RowLayout& layout) : stride_(layout.stride) {
  for (const Property& property : layout.properties) columns_.push_back({.property = property});
}

void ImportSurvey::take(std::span<const std::byte> rows) {
  RowLayout layout{.properties = {}, .stride = stride_};
  for (ImportedColumn& column : columns_) {
    layout.properties.push_back(column.property);
    with_type(column.property.type, [&](auto value) {
      for (const std::byte* row = rows.data(); row != rows.data() + rows.size(); row += stride_) {
        value = load<decltype(value)>(row + column.property.offset);
        if constexpr (std::is_floating_point_v<decltype(value)>)
          column.is_whole = column.is_whole && std::trunc(value) == value;  // not so for NaN
        column.min = std::min(column.min, static_cast<double>(value));
        column.max = std::max(column.max, static_cast<double>(value));
      }
    });
  }
  const std::array<Property, 3> position = position_of(layout);
  for (const std::byte* row = rows.data(); row != rows.data() + rows.size(); row += stride_) {
    const Eigen::Vector3d point = load_position(position, row);
    if (point.allFinite()) bounds_.extend(point);
  }
}

void import_las_rows(const RowLayout& layout, const LasForm& form, std::span<const std::byte> rows,
                     std::size_t stride, std::byte* out, std::vector<std::size_t>& left_out) {
  left_out.clear();
  const std::size_t count = rows.size() / layout.stride;
  const std::array<Property, 3> position = position_of(layout);
  std::vector<std::byte> empty(form.record_bytes);
  std::set<std::size_t> given;
  for (const ImportedField& imported : form.imported) {
    if (!imported.field) given.insert(imported.extra);
  }
  for (std::size_t i = 0; i < form.extra.size(); ++i) {
    if (given.contains(i)) continue;
    const std::vector<std::byte> missing = las_extra_missing(form.extra[i].what);
    std::copy(missing.begin(), missing.end(),
              empty.begin() + static_cast<std::ptrdiff_t>(form.extra[i].offset));
  }
  for (std::size_t row = 0; row < count; ++row) {
    std::byte* const to = out + row * stride;
    std::memcpy(to, empty.data(), empty.size());
    const Eigen::Vector3d point = load_position(position, &rows[row * layout.stride]);
    if (!point.allFinite()) {
      left_out.push_back(row);
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double steps =
          std::round((point[static_cast<Eigen::Index>(axis)] - form.offset[axis]) / form.scale[axis]);
      if (!(std::abs(steps) <= 2147483647.0))
        throw Error(form.name + ": the input has changed during the run; it must stay as it is");
      store(to + 4 * axis, static_cast<std::int32_t>(steps));
    }
  }
  for (const ImportedField& imported : form.imported) {
    if (imported.field) {
      put_field(imported, layout, rows, stride, out);
    } else {
      const LasExtraField& extra = form.extra[imported.extra];
      copy_column(
          {.data = rows.data() + imported.from.offset, .stride = layout.stride, .type = imported.from.type},
          {.data = out + extra.offset, .stride = stride, .type = las_extra_type(extra.what.type).kept},
          count);
    }
  }
}

}  // namespace lacuna::io
