// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_fields.hpp"

#include <optional>

namespace lacuna::io {
namespace {

// Formats 6 to 10 have larger fields for returns, class and scan angle.
bool is_extended_format(int format) {
  return format >= 6;
}

// The first byte of each group of fields that only some formats have.
struct LasGroups {
  std::optional<std::size_t> gps_time, colour, infrared, waveform;
};

LasGroups las_groups(int format) {
  LasGroups groups;
  std::size_t next = 20;
  if (is_extended_format(format)) {
    groups.gps_time = 22;
    next = 30;
  } else if (format == 1 || format >= 3) {
    groups.gps_time = next;
    next += 8;
  }
  if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10) {
    groups.colour = next;
    next += 6;
  }
  if (format == 8 || format == 10) {
    groups.infrared = next;
    next += 2;
  }
  if (format == 4 || format == 5 || format == 9 || format == 10) groups.waveform = next;
  return groups;
}

}  // namespace

std::vector<LasField> las_fields(int format) {
  std::vector<LasField> fields;
  const auto bits = [&](const char* name, std::size_t offset, std::uint8_t shift, std::uint8_t count) {
    fields.push_back({.name = name, .type = Scalar::kUint8, .offset = offset, .shift = shift, .bits = count});
  };
  const auto whole = [&](const char* name, Scalar type, std::size_t offset) {
    fields.push_back({.name = name, .type = type, .offset = offset});
  };
  const LasGroups groups = las_groups(format);
  whole("intensity", Scalar::kUint16, 12);
  if (!is_extended_format(format)) {
    bits("return_number", 14, 0, 3);
    bits("number_of_returns", 14, 3, 3);
    bits("scan_direction_flag", 14, 6, 1);
    bits("edge_of_flight_line", 14, 7, 1);
    bits("classification", 15, 0, 5);
    bits("synthetic", 15, 5, 1);
    bits("key_point", 15, 6, 1);
    bits("withheld", 15, 7, 1);
    whole("scan_angle", Scalar::kInt8, 16);
    whole("user_data", Scalar::kUint8, 17);
    whole("point_source_id", Scalar::kUint16, 18);
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
    whole("classification", Scalar::kUint8, 16);
    whole("user_data", Scalar::kUint8, 17);
    fields.push_back(
        {.name = "scan_angle", .type = Scalar::kFloat32, .offset = 18, .stored = 4, .scale = 0.006});
    whole("point_source_id", Scalar::kUint16, 20);
  }
  if (groups.gps_time) whole("gps_time", Scalar::kFloat64, *groups.gps_time);
  if (groups.colour) {
    whole("red", Scalar::kUint16, *groups.colour);
    whole("green", Scalar::kUint16, *groups.colour + 2);
    whole("blue", Scalar::kUint16, *groups.colour + 4);
  }
  if (groups.infrared) whole("nir", Scalar::kUint16, *groups.infrared);
  if (groups.waveform) {
    const std::size_t at = *groups.waveform;
    whole("wave_packet_descriptor", Scalar::kUint8, at);
    fields.push_back(
        {.name = "wave_packet_offset", .type = Scalar::kFloat64, .offset = at + 1, .stored = 7});
    whole("wave_packet_bytes", Scalar::kUint32, at + 9);
    whole("wave_return_location", Scalar::kFloat32, at + 13);
    whole("wave_x", Scalar::kFloat32, at + 17);
    whole("wave_y", Scalar::kFloat32, at + 21);
    whole("wave_z", Scalar::kFloat32, at + 25);
  }
  return fields;
}

}  // namespace lacuna::io
