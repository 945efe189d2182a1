// SPDX-License-Identifier: Apache-2.0
// Encodes POINT14, versions 3 and 4, as io/laz/point14.hpp decodes it.
#pragma once

#include "io/laz/layer_encoder.hpp"
#include "io/laz/point14_channel.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace lacuna::io::laz {

class Point14Encoder {
 public:
  // `first`: the chunk's first point, which is not compressed.
  explicit Point14Encoder(const std::byte* first);

  // Reads the next point.
  void encode(const std::byte* item);

  unsigned channel() const { return channel_; }
  // Whether the last point was the first after one of another channel.
  bool changed_channel() const { return changed_channel_; }

  // Layers are in the order of the chunk.
  std::span<LayerEncoder> layers() { return layers_; }

 private:
  enum LayerIndex : std::size_t {
    kReturnsXyLayer,
    kZLayer,
    kClassificationLayer,
    kFlagsLayer,
    kIntensityLayer,
    kScanAngleLayer,
    kUserDataLayer,
    kPointSourceLayer,
    kGpsTimeLayer,
    kLayerCount
  };
  static_assert(kLayerCount == point14::kLayers);

  ArithmeticEncoder& layer(LayerIndex index) { return layers_[index].encoder; }
  unsigned encode_changes(const point14::Fields& now, unsigned channel);
  void encode_returns(point14::Channel& channel, const point14::Fields& now, unsigned changed);
  void encode_position(point14::Channel& channel, const point14::Fields& now, bool new_time);
  void encode_attributes(point14::Channel& channel, const point14::Fields& now, unsigned changed);

  std::array<LayerEncoder, kLayerCount> layers_;
  std::array<std::unique_ptr<point14::Channel>, point14::kChannels> channels_;
  unsigned channel_;
  bool changed_channel_ = false;
};

}  // namespace lacuna::io::laz
