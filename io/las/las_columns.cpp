#include "io/las/las_columns.hpp"

#include "io/little_endian.hpp"
#include "io/property_name.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace lacuna {
namespace {

// Types 1 to 10 of extra bytes (LAS 1.4, table 24), and how they are kept.
struct ExtraType {
  std::size_t bytes;
  Scalar kept;
};
constexpr std::array<ExtraType, 11> kExtraTypes = {{{0, Scalar::kUint8},
                                                    {1, Scalar::kUint8},
                                                    {1, Scalar::kInt8},
                                                    {2, Scalar::kUint16},
                                                    {2, Scalar::kInt16},
                                                    {4, Scalar::kUint32},
                                                    {4, Scalar::kInt32},
                                                    {8, Scalar::kFloat64},
                                                    {8, Scalar::kFloat64},
                                                    {4, Scalar::kFloat32},
                                                    {8, Scalar::kFloat64}}};
constexpr std::uint8_t kUint64 = 7, kInt64 = 8;

double load_stored(std::uint8_t type, const std::byte* from) {
  if (type == kUint64) return static_cast<double>(load<std::uint64_t>(from));
  if (type == kInt64) return static_cast<double>(load<std::int64_t>(from));
  return with_type(kExtraTypes[type].kept,
                   [&](auto zero) { return static_cast<double>(load<decltype(zero)>(from)); });
}

}  // namespace

LasColumns::LasColumns(const LasHeader& header) : record_bytes_(header.record_bytes) {
  using Kind = Source::Kind;
  const auto bits = [&](const char* name, std::size_t offset, std::uint8_t shift, std::uint8_t count) {
    add(name, Scalar::kUint8,
        {.kind = Kind::kBits,
         .offset = offset,
         .shift = shift,
         .mask = static_cast<std::uint8_t>((1u << count) - 1)});
  };
  const auto copy = [&](const std::string& name, Scalar type, std::size_t offset) {
    add(name, type, {.kind = Kind::kCopy, .offset = offset});
  };

  const char* const axes[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add(axes[axis], Scalar::kFloat64,
        {.kind = Kind::kCoordinate,
         .offset = 4 * axis,
         .scale = header.scale[axis],
         .added = header.offset[axis]});
  }
  copy("intensity", Scalar::kUint16, 12);
  const int format = header.point_format;
  std::size_t next = 20;  // behind the part that all formats have
  if (format < 6) {
    bits("return_number", 14, 0, 3);
    bits("number_of_returns", 14, 3, 3);
    bits("scan_direction_flag", 14, 6, 1);
    bits("edge_of_flight_line", 14, 7, 1);
    bits("classification", 15, 0, 5);
    bits("synthetic", 15, 5, 1);
    bits("key_point", 15, 6, 1);
    bits("withheld", 15, 7, 1);
    copy("scan_angle", Scalar::kInt8, 16);
    copy("user_data", Scalar::kUint8, 17);
    copy("point_source_id", Scalar::kUint16, 18);
    if (format == 1 || format >= 3) {
      copy("gps_time", Scalar::kFloat64, next);
      next += 8;
    }
  } else {
    bits("return_number", 14, 0, 4);
    bits("number_of_returns", 14, 4, 4);
    bits("synthetic", 15, 0, 1);
    bits("key_point", 15, 1, 1);
    bits("withheld", 15, 2, 1);
    bits("overlap", 15, 3, 1);
    bits("scanner_channel", 15, 4, 2);
    bits("scan_direction_flag", 15, 6, 1);
    bits("edge_of_flight_line", 15, 7, 1);
    copy("classification", Scalar::kUint8, 16);
    copy("user_data", Scalar::kUint8, 17);
    copy("scan_angle", Scalar::kInt16, 18);  // in steps of 0.006 degrees
    copy("point_source_id", Scalar::kUint16, 20);
    copy("gps_time", Scalar::kFloat64, 22);
    next = 30;
  }
  if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10) {
    for (const char* colour : {"red", "green", "blue"}) {
      copy(colour, Scalar::kUint16, next);
      next += 2;
    }
  }
  if (format == 8 || format == 10) {
    copy("nir", Scalar::kUint16, next);
    next += 2;
  }
  if (format == 4 || format == 5 || format == 9 || format == 10) {
    copy("wave_packet_descriptor", Scalar::kUint8, next);
    add("wave_packet_offset", Scalar::kFloat64,
        {.kind = Kind::kScaled, .offset = next + 1, .stored = kUint64});
    copy("wave_packet_bytes", Scalar::kUint32, next + 9);
    copy("wave_return_location", Scalar::kFloat32, next + 13);
    for (const char* name : {"wave_x", "wave_y", "wave_z"}) {
      copy(name, Scalar::kFloat32, next + 17);
      next += 4;
    }
    next += 17;
  }
  for (const LasExtraBytes& extra : header.extra_bytes) add_extra(extra, next);
  for (std::size_t i = 0; next < record_bytes_; ++next, ++i)
    copy("extra_" + std::to_string(i), Scalar::kUint8, next);
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
  const std::size_t bytes = kExtraTypes[type].bytes;
  for (std::size_t i = 0; i < values && offset + bytes <= record_bytes_; ++i, offset += bytes) {
    const std::string given = extra.name.empty() ? "extra" : extra.name;
    const std::string name = values > 1 ? given + "_" + std::to_string(i) : given;
    const bool is_scaled = extra.scale != 1 || extra.offset != 0 || type == kUint64 || type == kInt64;
    if (is_scaled) {
      add(name, Scalar::kFloat64,
          {.kind = Kind::kScaled,
           .offset = offset,
           .stored = type,
           .scale = extra.scale,
           .added = extra.offset});
    } else {
      add(name, kExtraTypes[type].kept, {.kind = Kind::kCopy, .offset = offset});
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
          fill([&](const std::byte* at) {
            return load_stored(source.stored, at) * source.scale + source.added;
          });
          break;
      }
    }
  }
}

}  // namespace lacuna
