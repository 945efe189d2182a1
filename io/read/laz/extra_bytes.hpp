// SPDX-License-Identifier: Apache-2.0
// A byte of BYTE and BYTE14: the difference to the same byte of the last point (LAZ, "BYTE", "BYTE14").
#pragma once

#include "io/read/laz/symbol_model.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna::io::laz {

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

}  // namespace lacuna::io::laz
