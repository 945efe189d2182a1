// SPDX-License-Identifier: Apache-2.0
// WAVEPACKET13 and WAVEPACKET14: where the waveform of a point is, and how it runs through space (LAZ,
// "WAVEPACKET13"). The items are the same; WAVEPACKET14 has a layer and models for each scanner channel.
#pragma once

#include "io/read/files/little_endian.hpp"
#include "io/read/laz/integer_coder.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace lacuna::io::laz {

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

}  // namespace lacuna::io::laz
