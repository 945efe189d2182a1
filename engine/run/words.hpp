// SPDX-License-Identifier: Apache-2.0
// Words in messages: lists of what is allowed, what may have been meant, and UTF-8 as RFC 3629 has it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

// Returns a list such as "k, eps, eps_fraction".
std::string listed(const std::vector<std::string_view>& words);

// Returns " (did you mean "k"?)" where one of the words is close to this one, else an empty string.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& words);

// Returns the bytes of the character that `text` begins with, and 0 where it begins with no character.
// Overlong forms, surrogates and values above U+10FFFF are no characters.
inline std::size_t utf8_length(std::string_view text) {
  const auto byte = [text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto follows = [&](std::size_t i, unsigned from = 0x80, unsigned to = 0xbf) {
    return from <= byte(i) && byte(i) <= to;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return text.empty() ? 0 : 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  if (first < 0xe0) return follows(1) ? 2 : 0;
  if (first < 0xf0) {
    return follows(1, first == 0xe0 ? 0xa0 : 0x80, first == 0xed ? 0x9f : 0xbf) && follows(2) ? 3 : 0;
  }
  const bool is_valid = follows(1, first == 0xf0 ? 0x90 : 0x80, first == 0xf4 ? 0x8f : 0xbf);
  return is_valid && follows(2) && follows(3) ? 4 : 0;
}

// Returns whether a character is a control character: C0, DEL or C1, which is U+0080 to U+009F, C2 80 to C2
// 9F.
inline bool is_control(std::string_view character) {
  const auto last = static_cast<unsigned char>(character.back());
  if (character.size() == 1) return last < 0x20 || last == 0x7f;
  return character.size() == 2 && character.front() == '\xc2' && last < 0xa0;
}

}  // namespace lacuna
