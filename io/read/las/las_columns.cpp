// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_columns.hpp"

#include "io/read/files/little_endian.hpp"
#include "io/read/files/property_name.hpp"
#include "io/read/las/las_extra.hpp"
#include "io/read/las/las_fields.hpp"
#include "io/read/rows/scalar.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::uint8_t kUint64 = 7, kInt64 = 8;  // types of extra bytes

}  // namespace

LasColumns::LasColumns(const LasHeader& header) : record_bytes_(header.record_bytes) {
  using Kind = Source::Kind;
  const char* const axes[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add(axes[axis], Scalar::kFloat64,
        {.kind = Kind::kCoordinate,
         .offset = 4 * axis,
         .scale = header.scale[axis],
         .added = header.offset[axis]});
  }
  for (const LasField& field : las_fields(header.point_format)) {
    if (field.stored > 0) {
      add(field.name, field.type,
          {.kind = Kind::kScaled, .offset = field.offset, .stored = field.stored, .scale = field.scale});
    } else if (field.bits > 0) {
      add(field.name, field.type,
          {.kind = Kind::kBits,
           .offset = field.offset,
           .shift = field.shift,
           .mask = static_cast<std::uint8_t>((1u << field.bits) - 1)});
    } else {
      add(field.name, field.type, {.kind = Kind::kCopy, .offset = field.offset});
    }
  }
  std::size_t next = las_point_bytes(header.point_format);
  for (const LasExtraBytes& extra : header.extra_bytes) add_extra(extra, next);
  for (std::size_t i = 0; next < record_bytes_; ++next, ++i)
    add("extra_" + std::to_string(i), Scalar::kUint8, {.kind = Kind::kCopy, .offset = next});
}

void LasColumns::add(std::string name, Scalar type, Source source) {
  const std::string given = property_name(name);
  name = given;
  while (!names_.emplace(name, 1).second) name = given + "_" + std::to_string(++names_[given]);
  layout_.properties.push_back({.name = std::move(name), .type = type, .offset = layout_.stride});
  layout_.stride += size_of(type);
  sources_.push_back(source);
}

// Descriptors beyond the record's end are left out.
void LasColumns::add_extra(const LasExtraBytes& extra, std::size_t& offset) {
  using Kind = Source::Kind;
  if (extra.type > 30) return;
  const bool is_typed = extra.type > 0;
  const std::uint8_t type = is_typed ? static_cast<std::uint8_t>((extra.type - 1) % 10 + 1) : 1;
  const std::size_t values = is_typed ? (extra.type - 1u) / 10 + 1 : extra.options;
  const std::size_t bytes = las_extra_type(type).bytes;
  for (std::size_t i = 0; i < values && offset + bytes <= record_bytes_; ++i, offset += bytes) {
    const std::string given = extra.name.empty() ? "extra" : extra.name;
    const std::string name = values > 1 ? given + "_" + std::to_string(i) : given;
    const bool is_scaled = extra.scale != 1 || extra.offset != 0 || type == kUint64 || type == kInt64;
    const std::optional<double> no_data = las_no_data(extra, i);
    const Scalar kept = las_extra_type(type).kept;
    if (is_scaled || no_data) {
      add(name, is_scaled || is_integer(kept) ? Scalar::kFloat64 : kept,
          {.kind = Kind::kScaled,
           .offset = offset,
           .stored = type,
           .scale = extra.scale,
           .added = extra.offset,
           .no_data = no_data});
    } else {
      add(name, kept, {.kind = Kind::kCopy, .offset = offset});
    }
  }
}

void LasColumns::unpack(std::span<const std::byte> records, std::byte* rows) const {
  constexpr std::size_t kTogether = 512;  // rows that stay in the cache while column after column is filled
  const std::size_t count = records.size() / record_bytes_;
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t together = std::min(kTogether, count - first);
    for (std::size_t column = 0; column < sources_.size(); ++column) {
      const Source& source = sources_[column];
      const std::byte* from = &records[first * record_bytes_] + source.offset;
      std::byte* to = rows + first * layout_.stride + layout_.properties[column].offset;
      const auto fill = [&](auto&& value_of) {
        for (std::size_t i = 0; i < together; ++i, from += record_bytes_, to += layout_.stride) {
          const auto value = value_of(from);
          std::memcpy(to, &value, sizeof value);
        }
      };
      switch (source.kind) {
        case Source::Kind::kCoordinate:
          fill([&](const std::byte* at) {
            return static_cast<double>(load<std::int32_t>(at)) * source.scale + source.added;
          });
          break;
        case Source::Kind::kBits:
          fill([&](const std::byte* at) {
            return static_cast<std::uint8_t>((std::to_integer<unsigned>(*at) >> source.shift) & source.mask);
          });
          break;
        case Source::Kind::kCopy:
          with_type(layout_.properties[column].type,
                    [&](auto zero) { fill([](const std::byte* at) { return load<decltype(zero)>(at); }); });
          break;
        case Source::Kind::kScaled:
          const auto value_of = [&](const std::byte* at) {
            const double stored = load_las_value(source.stored, at);
            return stored == source.no_data ? std::numeric_limits<double>::quiet_NaN()
                                            : stored * source.scale + source.added;
          };
          if (layout_.properties[column].type == Scalar::kFloat32) {
            fill([&](const std::byte* at) { return nearest_float(value_of(at)); });
          } else {
            fill(value_of);
          }
          break;
      }
    }
  }
}

}  // namespace lacuna::io
