// SPDX-License-Identifier: Apache-2.0
// RGB12 version 2 and RGB14, NIR of RGBNIR14: colours of 16 bits (LAZ, "RGB12", "RGB14", "RGBNIR14").
#pragma once

#include "io/read/laz/arithmetic_decoder.hpp"
#include "io/read/laz/arithmetic_encoder.hpp"

#include <array>
#include <cstdint>

namespace lacuna::io::laz {

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

}  // namespace lacuna::io::laz
