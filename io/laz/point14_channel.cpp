// SPDX-License-Identifier: Apache-2.0
#include "io/laz/point14_channel.hpp"

#include "io/little_endian.hpp"

#include <algorithm>

namespace lacuna::io::laz::point14 {

Fields read_fields(const std::byte* item) {
  const unsigned returns = std::to_integer<unsigned>(item[14]), bits = std::to_integer<unsigned>(item[15]);
  return {
      .x = load<std::int32_t>(item),
      .y = load<std::int32_t>(item + 4),
      .z = load<std::int32_t>(item + 8),
      .intensity = load<std::uint16_t>(item + 12),
      .return_number = static_cast<std::uint8_t>(returns & 15),
      .number_of_returns = static_cast<std::uint8_t>(returns >> 4),
      .flags = static_cast<std::uint8_t>((bits & 15) | (bits >> 6) << 4),
      .classification = load<std::uint8_t>(item + 16),
      .user_data = load<std::uint8_t>(item + 17),
      .scan_angle = load<std::uint16_t>(item + 18),
      .point_source = load<std::uint16_t>(item + 20),
      .gps_time = load<std::uint64_t>(item + 22),
  };
}

unsigned channel_of(const std::byte* item) {
  return std::to_integer<unsigned>(item[15]) >> 4 & 3;
}

void write_fields(const Fields& fields, unsigned channel, std::byte* item) {
  store(item, fields.x);
  store(item + 4, fields.y);
  store(item + 8, fields.z);
  store(item + 12, fields.intensity);
  item[14] = static_cast<std::byte>(fields.number_of_returns << 4 | fields.return_number);
  item[15] = static_cast<std::byte>((fields.flags & 15) | channel << 4 | (fields.flags >> 4) << 6);
  store(item + 16, fields.classification);
  store(item + 17, fields.user_data);
  store(item + 18, fields.scan_angle);
  store(item + 20, fields.point_source);
  store(item + 22, fields.gps_time);
}

unsigned return_context(const Fields& fields, bool new_time) {
  // By number of returns (row) and return number (digit of the row).
  constexpr char kContexts[16][17] = {
      "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
      "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
      "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
      "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455",
  };
  const char digit = kContexts[fields.number_of_returns][fields.return_number];
  return static_cast<unsigned>(digit - '0') * 2 + (new_time ? 1 : 0);
}

unsigned place_in_pulse(const Fields& fields) {
  return (fields.return_number == 1 ? 1u : 0u) + (fields.return_number >= fields.number_of_returns ? 2u : 0u);
}

unsigned height_level(const Fields& fields) {
  return std::min(return_level(fields.number_of_returns, fields.return_number), 7u);
}

unsigned classification_context(const Fields& last, unsigned place) {
  return (last.classification & 31u) * 2 + (place == kOnlyReturn ? 1 : 0);
}

}  // namespace lacuna::io::laz::point14
