// SPDX-License-Identifier: Apache-2.0
// POINT14, versions 3 and 4: the 30 bytes that point formats 6 to 8 begin with (LAZ, "POINT14").
#pragma once

#include "io/laz/contexts.hpp"
#include "io/laz/gps_time.hpp"
#include "io/laz/integer_decoder.hpp"
#include "io/laz/layers.hpp"
#include "io/laz/streaming_median.hpp"

#include <array>
#include <cstddef>
#include <memory>

namespace lacuna::io::laz {

// Decodes nine layers. All models and last values belong to one of four scanner channels. Those of a channel
// begin, at its first point, with the values of the point before.
class Point14 {
 public:
  static constexpr std::size_t kBytes = 30;
  static constexpr std::size_t kLayers = 9;
  static constexpr unsigned kChannels = 4;

  // `first`: the chunk's first point, which is not compressed. Takes its layers' sizes from `layers`.
  Point14(const std::byte* first, Layers& layers);
  ~Point14();

  // Writes the next point.
  void decode(std::byte* item);

  unsigned channel() const { return channel_; }
  // Whether the last point was the first after one of another channel.
  bool changed_channel() const { return changed_channel_; }

 private:
  struct Fields {
    std::int32_t x, y, z;
    std::uint16_t intensity;
    std::uint8_t return_number, number_of_returns;
    std::uint8_t flags;  // classification flags, scan direction << 4, edge of flight line << 5
    std::uint8_t classification;
    std::uint8_t user_data;
    std::uint16_t scan_angle;  // as the bits of a signed number
    std::uint16_t point_source;
    std::uint64_t gps_time;  // the bits of a double
  };
  struct Channel;

  unsigned decode_changes();
  void decode_returns(Channel& channel, unsigned changed);
  void decode_position(Channel& channel, bool new_time);
  void decode_attributes(Channel& channel, unsigned changed);
  void write(const Fields& fields, std::byte* item) const;

  // In the order of the chunk. Those that hold one value for all points are empty, but for the first.
  Layer returns_xy_, z_, classification_, flags_, intensity_, scan_angle_, user_data_, point_source_,
      gps_time_;
  std::array<std::unique_ptr<Channel>, kChannels> channels_;
  unsigned channel_;
  bool changed_channel_ = false;
};

}  // namespace lacuna::io::laz
