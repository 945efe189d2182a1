// SPDX-License-Identifier: Apache-2.0
// The items of a point that both kinds of chunks code alike: extra bytes, colours and places of waveforms.
#pragma once

#include "io/read/files/number.hpp"
#include "io/read/laz/arithmetic_coder.hpp"
#include "io/read/laz/laz.hpp"
#include "io/read/laz/predicted_values.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lacuna::io::laz {

// A byte of BYTE and BYTE14: the difference to the same byte of the last point (LAZ, "BYTE", "BYTE14").

// Decodes `item`, or encodes it. Afterwards `last` is the same.
template <class Coder, class Byte>
void code_extra_byte(Coder& coder, SymbolModel<256>& model, std::byte& last, Byte& item) {
  const auto before = std::to_integer<unsigned>(last);
  std::uint8_t difference = 0;
  if constexpr (Coder::kEncodes)
    difference = static_cast<std::uint8_t>(std::to_integer<unsigned>(item) - before);
  coder.code(model, difference);
  last = static_cast<std::byte>(before + difference);
  if constexpr (!Coder::kEncodes) item = last;
}

// RGB12 version 2 and RGB14, NIR of RGBNIR14: colours of 16 bits (LAZ, "RGB12", "RGB14", "RGBNIR14").

// Bit 6 of the symbol that says which bytes changed: green and blue are not both equal to red.
inline constexpr unsigned kColoured = 1u << 6;

// Returns the bits of the bytes that differ, from the low one of the first value on.
inline unsigned changed_bytes(std::span<const std::uint16_t> last, std::span<const std::uint16_t> now) {
  unsigned changed = 0;
  for (unsigned i = 0; i < now.size(); ++i) {
    const unsigned different = last[i] ^ now[i];
    if (different & 255) changed |= 1u << (2 * i);
    if (different >> 8) changed |= 2u << (2 * i);
  }
  return changed;
}

// Codes the byte of `now` at a bit, 0 or 8, as its difference to a predicted one.
template <class Coder>
void code_byte(Coder& coder, SymbolModel<256>& model, unsigned at, int predicted, std::uint16_t& now) {
  auto difference = static_cast<std::uint8_t>((now >> at) - predicted);
  coder.code(model, difference);
  const int byte = (predicted + difference) & 255;
  now = static_cast<std::uint16_t>((now & ~(255 << at)) | byte << at);
}

using Rgb = std::array<std::uint16_t, 3>;

// Codes the bytes of a colour that differ from the last colour's; green and blue as difference to what red's,
// and then green's, difference predicts. A decoder changes `now` from the last colour to the next.
class RgbModels {
 public:
  template <class Coder>
  void code(Coder& coder, const Rgb& last, Rgb& now);

 private:
  SymbolModel<128> changed_;
  std::array<SymbolModel<256>, 6> bytes_;  // low and high of red, green and blue
};

class NirModels {
 public:
  template <class Coder>
  void code(Coder& coder, std::uint16_t last, std::uint16_t& now);

 private:
  SymbolModel<4> changed_;
  std::array<SymbolModel<256>, 2> bytes_;  // low and high
};

template <class Coder>
void RgbModels::code(Coder& coder, const Rgb& last, Rgb& now) {
  unsigned changed = 0;
  if constexpr (Coder::kEncodes)
    changed = changed_bytes(last, now) | (now[0] != now[1] || now[0] != now[2] ? kColoured : 0);
  coder.code(changed_, changed);
  // Codes a byte. The bytes of the channels before changed by `change`. Returns how far this one changed.
  const auto byte = [&](unsigned index, int change) {
    const unsigned channel = index / 2, at = index % 2 * 8;
    const int before = last[channel] >> at & 255;
    if (changed & 1u << index)
      code_byte(coder, bytes_[index], at, std::clamp(before + change, 0, 255), now[channel]);
    return (now[channel] >> at & 255) - before;
  };
  const int red_low = byte(0, 0), red_high = byte(1, 0);
  if (!(changed & kColoured)) {
    now[1] = now[2] = now[0];
    return;
  }
  byte(4, (red_low + byte(2, red_low)) / 2);
  byte(5, (red_high + byte(3, red_high)) / 2);
}

template <class Coder>
void NirModels::code(Coder& coder, std::uint16_t last, std::uint16_t& now) {
  unsigned changed = 0;
  if constexpr (Coder::kEncodes) changed = changed_bytes(std::span(&last, 1), std::span(&now, 1));
  coder.code(changed_, changed);
  if (changed & 1) code_byte(coder, bytes_[0], 0, last & 255, now);
  if (changed & 2) code_byte(coder, bytes_[1], 8, last >> 8, now);
}

// WAVEPACKET13 and WAVEPACKET14: where the waveform of a point is, and how it runs through space (LAZ,
// "WAVEPACKET13"). The items are the same; WAVEPACKET14 has a layer and models for each scanner channel.

// A descriptor's index, the place and size of the packet, the place of the return in it, and a direction.
using Wavepacket = std::array<std::byte, 29>;

class WavepacketModels {
 public:
  // Codes the packet that follows `last`. A decoder changes `now` from the last packet to the next.
  template <class Coder>
  void code(Coder& coder, const Wavepacket& last, Wavepacket& now) {
    constexpr std::size_t kOffsetAt = 1, kSizeAt = 9, kPlaceAt = 13, kDirectionAt = 17;
    auto index = std::to_integer<std::uint8_t>(now[0]);
    coder.code(index_, index);
    now[0] = std::byte{index};
    const auto before = load<std::uint64_t>(&last[kOffsetAt]);
    auto offset = load<std::uint64_t>(&now[kOffsetAt]);
    code_offset(coder, before, load<std::uint32_t>(&last[kSizeAt]), offset);
    store(&now[kOffsetAt], offset);
    const auto code_word = [&](auto& words, std::size_t at, unsigned context) {
      auto word = load<std::uint32_t>(&now[at]);
      words.code(coder, load<std::uint32_t>(&last[at]), word, context);
      store(&now[at], word);
    };
    code_word(size_, kSizeAt, 0);
    code_word(place_, kPlaceAt, 0);
    for (unsigned axis = 0; axis < 3; ++axis) code_word(direction_, kDirectionAt + 4 * axis, axis);
  }

 private:
  // Packets mostly follow each other, or lie as far apart as the last two.
  template <class Coder>
  void code_offset(Coder& coder, std::uint64_t before, std::uint32_t size, std::uint64_t& offset) {
    enum : std::uint8_t { kSame, kNext, kStep, kAnywhere };
    const auto step = static_cast<std::int64_t>(offset - before);
    auto step32 = static_cast<std::uint32_t>(step);
    std::uint8_t kind = kAnywhere;
    if (offset == before) {
      kind = kSame;
    } else if (offset == before + size) {
      kind = kNext;
    } else if (step == static_cast<std::int32_t>(step)) {
      kind = kStep;
    }
    coder.code(kinds_[last_kind_], kind);
    last_kind_ = kind;
    if (kind == kSame) offset = before;
    if (kind == kNext) offset = before + size;
    if (kind == kStep) {
      step_.code(coder, last_step_, step32);
      last_step_ = step32;
      offset = before + static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(step32)});
    }
    if (kind == kAnywhere) code_whole(coder, offset);
  }
  static void code_whole(ArithmeticDecoder& decoder, std::uint64_t& offset) {
    const std::uint64_t low = decoder.bits(32);
    offset = std::uint64_t{decoder.bits(32)} << 32 | low;
  }
  static void code_whole(ArithmeticEncoder& encoder, const std::uint64_t& offset) {
    encoder.bits(static_cast<std::uint32_t>(offset), 32);
    encoder.bits(static_cast<std::uint32_t>(offset >> 32), 32);
  }

  SymbolModel<256> index_;
  std::array<SymbolModel<4>, 4> kinds_;  // by the kind of the last packet's offset
  std::uint8_t last_kind_ = 0;
  std::uint32_t last_step_ = 0;
  IntegerCoder<32> step_, size_, place_;
  IntegerCoder<32, 3> direction_;
};

// The two kinds of chunks: point by point (pointwise.cpp), and a layer for each attribute (layered.cpp).

// Decodes the records of a chunk after the first, from front to back.
class RecordDecoder {
 public:
  virtual ~RecordDecoder() = default;
  virtual void decode(std::span<std::byte> records) = 0;
  // As `ChunkDecoder::has_other_than`.
  virtual bool has_other_than(std::uint64_t points) const = 0;
};

// Chunks of point formats 0 to 3: all items of a point in one stream, point by point (LAZ, compressor 2).

// The records of a chunk after the first, which is not compressed.
std::unique_ptr<RecordDecoder> pointwise_decoder(const Layout& layout, const ChunkBytes& bytes,
                                                 std::span<const std::byte> first);

// Encodes a chunk of the given records, at least one, with items of version 2.
std::vector<std::byte> pointwise_chunk(const Layout& layout, std::span<const std::byte> records);

// Chunks of point formats 6 to 8: each attribute in a stream of its own (LAZ, compressor 3).

// The records of a chunk after the first, which is not compressed.
std::unique_ptr<RecordDecoder> layered_decoder(const Layout& layout, const ChunkBytes& bytes,
                                               std::span<const std::byte> first);

// Encodes a chunk of the given records, at least one.
std::vector<std::byte> layered_chunk(const Layout& layout, std::span<const std::byte> records);

std::size_t layer_count(const Layout& layout);

}  // namespace lacuna::io::laz
