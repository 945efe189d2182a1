// SPDX-License-Identifier: Apache-2.0
// POINT14, versions 3 and 4: the 30 bytes that point formats 6 to 8 begin with (LAZ, "POINT14").
#pragma once

#include "io/laz/layers.hpp"
#include "io/laz/point14_channel.hpp"

#include <array>
#include <cstddef>
#include <memory>

namespace lacuna::io::laz {

// Decodes nine layers.
class Point14Decoder {
 public:
  // `first`: the chunk's first point, which is not compressed. Takes its layers' sizes from `layers`.
  Point14Decoder(const std::byte* first, Layers& layers);

  // Writes the next point.
  void decode(std::byte* item);

  unsigned channel() const { return channel_; }
  // Whether the last point was the first after one of another channel.
  bool changed_channel() const { return changed_channel_; }

 private:
  unsigned decode_changes();
  void decode_returns(point14::Channel& channel, unsigned changed);
  void decode_position(point14::Channel& channel, bool new_time);
  void decode_attributes(point14::Channel& channel, unsigned changed);

  // Layers are in the order of the chunk. Layers that hold one value for all points are empty, but the first
  // never is.
  Layer returns_xy_, z_, classification_, flags_, intensity_, scan_angle_, user_data_, point_source_,
      gps_time_;
  std::array<std::unique_ptr<point14::Channel>, point14::kChannels> channels_;
  unsigned channel_;
  bool changed_channel_ = false;
};

}  // namespace lacuna::io::laz
