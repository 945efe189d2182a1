// SPDX-License-Identifier: Apache-2.0
#include "io/results/digits.hpp"

#include <charconv>
#include <cmath>

namespace lacuna::io {

void append_shortest(std::string& text, double value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void append_plain(std::string& text, double value) {
  const double size = std::abs(value);
  if (size != 0 && !(size >= 1e-15 && size < 1e15)) return append_shortest(text, value);
  char digits[64];  // at most 15 zeros behind the point, and 17 digits
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed).ptr);
}

}  // namespace lacuna::io
