// SPDX-License-Identifier: Apache-2.0
// POINT14, versions 3 and 4: the 30 bytes that point formats 6 to 8 begin with (LAZ, "POINT14").
#pragma once

#include "io/read/laz/layers.hpp"
#include "io/read/laz/point14_channel.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace lacuna::io::laz {

// Decodes or encodes points, by the kind of their layers.
template <class Layer>
class Point14 {
 public:
  static constexpr std::size_t kLayers = 9;

  // `first`: the chunk's first point, which is not compressed. The layers outlive this. Throws `Corrupt` if
  // the first one, which every chunk has, is empty.
  Point14(const std::byte* first, std::span<Layer, kLayers> layers);

  // Decodes the next point to `item`, or encodes it from there.
  void code(ItemByte<Layer>* item);

  unsigned channel() const { return channel_; }
  // Whether the last point was the first after one of another channel.
  bool changed_channel() const { return changed_channel_; }

 private:
  // The layers, in the order of the chunk.
  enum LayerIndex : std::size_t {
    kReturnsXy,
    kZ,
    kClassification,
    kFlags,
    kIntensity,
    kScanAngle,
    kUserData,
    kPointSource,
    kGpsTime
  };
  static_assert(kGpsTime + 1 == kLayers);

  unsigned changes_to(const point14::Fields& now, unsigned channel) const;
  unsigned code_changes(const point14::Fields& now, unsigned channel);
  void code_returns(point14::Channel& channel, point14::Fields& now, unsigned changed);
  void code_position(point14::Channel& channel, point14::Fields& now, bool new_time);
  void code_attributes(point14::Channel& channel, point14::Fields& now, unsigned changed);

  std::span<Layer, kLayers> layers_;
  std::array<std::unique_ptr<point14::Channel>, point14::kChannels> channels_;
  unsigned channel_;
  bool changed_channel_ = false;
};

}  // namespace lacuna::io::laz
