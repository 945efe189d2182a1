// SPDX-License-Identifier: Apache-2.0
// Adaptive models of the arithmetic coder (Said, section 2.2 and appendix; LAZ, "Entropy coding").
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace lacuna::io::laz {

// How often each symbol of an alphabet occurred, and its share of the coder's interval. The shares are
// computed anew after more and more symbols, so that few steps pay for it.
template <unsigned kCapacity>
class SymbolModel {
 public:
  static constexpr unsigned kShareBits = 15;  // a share is a number of 2^-15
  static constexpr bool kHasTable = kCapacity > 16;

  // At first all symbols are equally frequent. `symbols` is 2 to kCapacity.
  explicit SymbolModel(unsigned symbols = kCapacity) : symbols_(symbols) {
    std::fill_n(counts_.begin(), symbols, std::uint16_t{1});
    if constexpr (kHasTable) {
      unsigned bits = 3;
      while (symbols > 1u << (bits + 2)) ++bits;
      table_shift_ = kShareBits - bits;
    }
    cycle_ = symbols;
    update();
    cycle_ = until_update_ = (symbols + 6) / 2;
  }

  unsigned symbols() const { return symbols_; }

  // Returns the sum of the shares of all symbols before `symbol`.
  std::uint32_t start(unsigned symbol) const { return starts_[symbol]; }

  // A place in the interval belongs to a symbol from `low` to `high`. The table has both.
  struct Bracket {
    unsigned low, high;
  };
  Bracket bracket(std::uint32_t place) const {
    const std::uint32_t slot = place >> table_shift_;
    return {table_[slot], table_[slot + 1]};
  }

  void count(unsigned symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }

 private:
  static constexpr std::uint32_t kMaxTotal = 1u << kShareBits;
  static constexpr unsigned table_slots() {
    unsigned slots = 8;
    while (kCapacity > slots * 4) slots *= 2;
    return slots;
  }

  void update() {
    total_ += cycle_;
    if (total_ > kMaxTotal) {
      total_ = 0;
      for (unsigned s = 0; s < symbols_; ++s) {
        counts_[s] = static_cast<std::uint16_t>((counts_[s] + 1) / 2);
        total_ += counts_[s];
      }
    }
    const std::uint32_t scale = 0x80000000u / total_;
    std::uint32_t sum = 0;
    unsigned slot = 0;
    for (unsigned s = 0; s < symbols_; ++s) {
      starts_[s] = static_cast<std::uint16_t>((scale * sum) >> (31 - kShareBits));
      sum += counts_[s];
      if constexpr (kHasTable) {
        const unsigned reached = starts_[s] >> table_shift_;
        while (slot < reached) table_[++slot] = static_cast<std::uint16_t>(s - 1);
      }
    }
    if constexpr (kHasTable) {
      // Two slots more than the interval has: rounding in the decoder can place a symbol just behind its end.
      const unsigned slots = (1u << (kShareBits - table_shift_)) + 1;
      while (slot < slots) table_[++slot] = static_cast<std::uint16_t>(symbols_ - 1);
      table_[0] = 0;
    }
    cycle_ = std::min(5 * cycle_ / 4, (symbols_ + 6) * 8);
    until_update_ = cycle_;
  }

  std::array<std::uint16_t, kCapacity> starts_{};
  std::array<std::uint16_t, kCapacity> counts_{};
  std::array<std::uint16_t, kHasTable ? table_slots() + 2 : 1> table_{};
  std::uint32_t symbols_;
  std::uint32_t table_shift_ = 0;
  std::uint32_t total_ = 0;
  std::uint32_t cycle_ = 0;
  std::uint32_t until_update_ = 0;
};

// A model for an alphabet of two symbols.
class BitModel {
 public:
  static constexpr unsigned kShareBits = 13;

  // The share of bit 0, a number of 2^-13.
  std::uint32_t share_of_zero() const { return share_; }

  void count(bool bit) {
    if (!bit) ++zeros_;
    if (--until_update_ == 0) update();
  }

 private:
  void update() {
    total_ += cycle_;
    if (total_ > 1u << kShareBits) {
      total_ = (total_ + 1) / 2;
      zeros_ = (zeros_ + 1) / 2;
      if (zeros_ == total_) ++total_;
    }
    const std::uint32_t scale = 0x80000000u / total_;
    share_ = (zeros_ * scale) >> (31 - kShareBits);
    cycle_ = std::min(5 * cycle_ / 4, 64u);
    until_update_ = cycle_;
  }

  std::uint32_t share_ = 1u << (kShareBits - 1);
  std::uint32_t zeros_ = 1;
  std::uint32_t total_ = 2;
  std::uint32_t cycle_ = 4;
  std::uint32_t until_update_ = 4;
};

}  // namespace lacuna::io::laz
