// SPDX-License-Identifier: Apache-2.0
#include "io/e57/page_checksum.hpp"

#include "io/files/little_endian.hpp"

#include <array>

namespace lacuna::io {
namespace {

constexpr std::uint32_t kPolynomial = 0x82f63b78;  // 0x1edc6f41 with its bits reversed
constexpr std::size_t kTogether = 8;

using Table = std::array<std::uint32_t, 256>;

// Table k has the checksum of each byte that k bytes of zero follow.
constexpr std::array<Table, kTogether> kTables = [] {
  std::array<Table, kTogether> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ ((rest & 1) != 0 ? kPolynomial : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < kTogether; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = before >> 8 ^ tables[0][before & 255];
    }
  }
  return tables;
}();

}  // namespace

// Processes eight bytes at once: Kounavis, Berry, A systematic approach to building high performance
// software-based CRC generators, ISCC 2005.
std::uint32_t page_checksum(std::span<const std::byte> data) {
  std::uint32_t checksum = ~std::uint32_t{0};
  for (; data.size() >= kTogether; data = data.subspan(kTogether)) {
    const std::uint64_t word = load<std::uint64_t>(data.data()) ^ checksum;
    checksum = 0;
    for (std::size_t i = 0; i < kTogether; ++i) checksum ^= kTables[kTogether - 1 - i][word >> 8 * i & 255];
  }
  for (const std::byte byte : data) {
    checksum = checksum >> 8 ^ kTables[0][(checksum ^ std::to_integer<std::uint32_t>(byte)) & 255];
  }
  return ~checksum;
}

}  // namespace lacuna::io
