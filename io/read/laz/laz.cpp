// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/laz.hpp"

#include "io/read/laz/arithmetic_decoder.hpp"
#include "io/read/laz/layered.hpp"
#include "io/read/laz/pointwise.hpp"
#include "io/read/laz/symbol_model.hpp"

#include <algorithm>

namespace lacuna::io::laz {

ChunkDecoder::ChunkDecoder(const Layout& layout, const ChunkBytes& bytes) : layout_(layout), bytes_(bytes) {}

ChunkDecoder::~ChunkDecoder() = default;

void ChunkDecoder::decode(std::span<std::byte> records) {
  if (!records.empty() && first_.empty()) {
    // The first point is not compressed.
    const std::size_t record_bytes = layout_.record_bytes();
    if (bytes_.size() < record_bytes)
      throw Corrupt("a chunk of compressed points is shorter than its first point");
    first_ = read_all(bytes_, 0, record_bytes);
    std::copy(first_.begin(), first_.end(), records.begin());
    records = records.subspan(record_bytes);
  }
  if (records.empty()) return;
  begin_rest();
  rest_->decode(records);
}

void ChunkDecoder::begin_rest() {
  if (rest_) return;
  rest_ = layout_.compressor == compressor::kLayeredChunked ? layered_decoder(layout_, bytes_, first_)
                                                            : pointwise_decoder(layout_, bytes_, first_);
}

bool ChunkDecoder::has_other_than(std::uint64_t points) {
  if (bytes_.size() == first_.size()) return false;  // a point alone
  begin_rest();
  return rest_->has_other_than(points);
}

std::uint64_t decoder_bytes(const Layout& layout) {
  // Models of all values of three fields, in four scanner channels.
  constexpr std::uint64_t kPoints = std::uint64_t{2} << 20;
  // A model for each scanner channel and one to copy, and the decoder of the layer.
  constexpr std::uint64_t kLayeredByte = 5 * sizeof(SymbolModel<256>) + 128;
  constexpr std::uint64_t kPointwiseByte = sizeof(SymbolModel<256>);
  std::uint64_t bytes = kPoints;
  for (const Item& item : layout.items) {
    if (item.type == item_type::kByte) bytes += item.size * kPointwiseByte;
    if (item.type == item_type::kByte14) bytes += item.size * kLayeredByte;
  }
  return bytes;
}

std::size_t stream_count(const Layout& layout) {
  return layout.compressor == compressor::kLayeredChunked ? layer_count(layout) : 1;
}

}  // namespace lacuna::io::laz
