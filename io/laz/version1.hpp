// SPDX-License-Identifier: Apache-2.0
// Version 1 of the items of point formats 0 to 3, written before 2011 (LAZ, "Version 1").
#pragma once

#include "io/laz/contexts.hpp"
#include "io/laz/integer_coder.hpp"
#include "io/laz/rgb.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace lacuna::io::laz::version1 {

class Point10 {
 public:
  explicit Point10(const std::byte* first);
  void decode(ArithmeticDecoder& decoder, std::byte* item);

 private:
  struct Fields {
    std::int32_t x, y, z;
    std::uint16_t intensity;
    std::uint8_t returns, classification, scan_angle, user_data;
    std::uint16_t point_source;
  };
  Fields last_;
  std::array<std::int32_t, 3> last_dx_{}, last_dy_{};
  std::size_t next_difference_ = 0;

  IntegerCoder<32> dx_;
  IntegerCoder<32, 20> dy_, z_;
  SymbolModel<64> changed_;
  IntegerCoder<16> intensity_;
  ModelByValue<256, 256> returns_, classification_, user_data_;
  IntegerCoder<8, 2> scan_angle_;
  IntegerCoder<16> point_source_;
};

class GpsTime11 {
 public:
  explicit GpsTime11(const std::byte* first);
  void decode(ArithmeticDecoder& decoder, std::byte* item);

 private:
  static constexpr unsigned kFactors = 510;  // 0 to 509, then a full time, then an unchanged one
  void decode_next(ArithmeticDecoder& decoder);
  void add(std::int32_t difference);

  std::uint64_t last_;
  std::int32_t difference_ = 0;
  int extremes_ = 0;
  SymbolModel<3> first_;
  SymbolModel<kFactors + 2> next_;
  IntegerCoder<32, 6> integers_;
};

class Rgb12 {
 public:
  explicit Rgb12(const std::byte* first);
  void decode(ArithmeticDecoder& decoder, std::byte* item);

 private:
  std::array<std::uint8_t, 6> last_;
  SymbolModel<64> changed_;
  IntegerCoder<8, 6> bytes_;
};

class ExtraBytes {
 public:
  ExtraBytes(const std::byte* first, std::size_t count);
  void decode(ArithmeticDecoder& decoder, std::byte* item);

 private:
  std::vector<std::byte> last_;
  std::vector<SymbolModel<9>> ks_;  // the contexts of an IntegerCoder<8>, as many as bytes
  IntegerCoder<8> integers_;
};

}  // namespace lacuna::io::laz::version1
