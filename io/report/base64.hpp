// SPDX-License-Identifier: Apache-2.0
// Bytes as text (RFC 4648), in one line.
#pragma once

#include "io/files/output_file.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna::io {

class Base64 {
 public:
  explicit Base64(OutputFile& out) : out_(out) {}

  void write(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      bits_ = bits_ << 8 | std::to_integer<std::uint32_t>(byte);
      if (++held_ == 3) put(4);
    }
  }
  void finish() {  // once, at the end
    const std::size_t held = held_;
    if (held == 0) return;
    bits_ <<= 8 * (3 - held);
    put(held + 1);
    out_.write(std::string_view("==").substr(held - 1));
  }

 private:
  void put(std::size_t digits) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char text[4];
    for (std::size_t i = 0; i < 4; ++i) text[i] = kDigits[bits_ >> (18 - 6 * i) & 63];
    out_.write(std::string_view(text, digits));
    bits_ = 0;
    held_ = 0;
  }

  OutputFile& out_;
  std::uint32_t bits_ = 0;
  std::size_t held_ = 0;  // bytes in `bits_`
};

}  // namespace lacuna::io
