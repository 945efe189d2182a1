// SPDX-License-Identifier: Apache-2.0
// POINT10, version 2: the 20 bytes that point formats 0 to 3 begin with (LAZ, "POINT10").
#pragma once

#include "io/read/laz/contexts.hpp"
#include "io/read/laz/integer_coder.hpp"
#include "io/read/laz/streaming_median.hpp"

#include <array>
#include <cstddef>

namespace lacuna::io::laz {

class Point10 {
 public:
  // `first`: the chunk's first point, which is not compressed.
  explicit Point10(const std::byte* first);

  // Decodes the next point to `item`, or encodes it from there.
  void code(ArithmeticDecoder& decoder, std::byte* item);
  void code(ArithmeticEncoder& encoder, const std::byte* item);

 private:
  struct Fields {
    std::int32_t x, y, z;
    std::uint16_t intensity;
    std::uint8_t returns;  // return number, number of returns, scan direction and edge of flight line
    std::uint8_t classification;
    std::uint8_t scan_angle;
    std::uint8_t user_data;
    std::uint16_t point_source;
  };
  static_assert(sizeof(Fields) == 20);

  unsigned changes_to(const Fields& now) const;
  template <class Coder>
  void code_fields(Coder& coder, Fields& now);

  Fields last_;
  std::array<std::uint16_t, 16> last_intensities_{};       // by context of return numbers
  std::array<StreamingMedian, 16> x_medians_, y_medians_;  // by context of return numbers
  std::array<std::int32_t, 8> last_heights_{};             // by return level

  SymbolModel<64> changed_;
  ModelByValue<256, 256> returns_;
  IntegerCoder<16, 4> intensity_;
  ModelByValue<256, 256> classification_;
  std::array<SymbolModel<256>, 2> scan_angle_;
  ModelByValue<256, 256> user_data_;
  IntegerCoder<16> point_source_;
  IntegerCoder<32, 2> dx_;
  IntegerCoder<32, 22> dy_;
  IntegerCoder<32, 20> z_;
};

}  // namespace lacuna::io::laz
