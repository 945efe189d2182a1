// The layers of a chunk of point formats 6 to 8 (LAZ, compressor 3).
#pragma once

#include "io/laz/arithmetic_decoder.hpp"
#include "io/little_endian.hpp"

#include <optional>

namespace lacuna::io::laz {

// A stream of one attribute, or nothing where the attribute is the first point's for all points.
using Layer = std::optional<ArithmeticDecoder>;

// Hands out layer after layer. The bytes are: the number of points, 4 bytes; the size of each layer, 4 bytes
// each; the layers.
class Layers {
 public:
  Layers(std::span<const std::byte> bytes, std::size_t count) : sizes_(bytes), layers_(bytes) {
    constexpr std::size_t kPointsBytes = 4;
    if (bytes.size() < kPointsBytes + kSizeBytes * count)
      throw Corrupt("a chunk of compressed points is cut");
    sizes_ = bytes.subspan(kPointsBytes, kSizeBytes * count);
    layers_ = bytes.subspan(kPointsBytes + kSizeBytes * count);
  }

  Layer next() {
    const std::size_t size = load<std::uint32_t>(sizes_.data());
    sizes_ = sizes_.subspan(kSizeBytes);
    if (size > layers_.size()) throw Corrupt("a layer of compressed points is cut");
    const auto layer = layers_.first(size);
    layers_ = layers_.subspan(size);
    return size == 0 ? Layer() : Layer(layer);
  }

 private:
  static constexpr std::size_t kSizeBytes = 4;
  std::span<const std::byte> sizes_, layers_;
};

}  // namespace lacuna::io::laz
