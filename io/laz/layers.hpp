// SPDX-License-Identifier: Apache-2.0
// The layers of a chunk of point formats 6 to 8 (LAZ, compressor 3).
#pragma once

#include "io/files/little_endian.hpp"
#include "io/laz/arithmetic_decoder.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace lacuna::io::laz {

// A stream of one attribute, or nothing where the attribute is the first point's for all points.
using Layer = std::optional<ArithmeticDecoder>;

// Hands out layer after layer. The bytes of the chunk from `begin` on are: the number of points, 4 bytes; the
// size of each layer, 4 bytes each; the layers.
class Layers {
 public:
  Layers(const ChunkBytes& bytes, std::uint64_t begin, std::size_t count)
      : bytes_(bytes), layer_at_(begin + kPointsBytes + kSizeBytes * count) {
    sizes_ = read_all(bytes, begin + kPointsBytes, layer_at_);
  }

  Layer next() {
    const std::uint64_t size = load<std::uint32_t>(&sizes_[kSizeBytes * next_++]);
    if (size > bytes_.size() - layer_at_) throw Corrupt("a layer of compressed points is cut");
    const std::uint64_t begin = layer_at_;
    layer_at_ += size;
    return size == 0 ? Layer() : Layer(std::in_place, bytes_, begin, layer_at_);
  }

 private:
  static constexpr std::size_t kPointsBytes = 4, kSizeBytes = 4;
  const ChunkBytes& bytes_;
  std::vector<std::byte> sizes_;
  std::size_t next_ = 0;
  std::uint64_t layer_at_;  // of the next layer, in the chunk
};

}  // namespace lacuna::io::laz
