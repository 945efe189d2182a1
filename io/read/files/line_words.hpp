// SPDX-License-Identifier: Apache-2.0
// The words of one line of a text format, taken one after the other.
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"

#include <string>
#include <string_view>

namespace lacuna::io {

// `line` must be the last one read from `in`: errors name its number.
class LineWords {
 public:
  LineWords(const InputFile& in, std::string_view line) : in_(in), rest_(line) {}

  // False, and an empty word, at the end of the line.
  bool next(std::string_view& word) {
    word = {};
    return next_field(rest_, ' ', word);
  }

  // The next word as a number. Throws `Error` if there is none or it is no number of the type; `needed` says
  // what the line must hold.
  template <class T>
  T number(std::string_view needed) {
    std::string_view word;
    if (!next(word)) fail("fewer values than needed; " + std::string(needed));
    T value;
    if (!parse_number(word, value)) fail(in_quotes(word) + " is not " + describe_number<T>());
    return value;
  }

  void require_end(std::string_view needed) {
    std::string_view word;
    if (next(word)) fail("more values than needed, from " + in_quotes(word) + " on; " + std::string(needed));
  }

  std::size_t count_left() const {
    std::size_t count = 0;
    std::string_view rest = rest_, word;
    while (next_field(rest, ' ', word)) ++count;
    return count;
  }

  [[noreturn]] void fail(const std::string& reason) const { in_.fail_at_line(in_.line(), reason); }

 private:
  const InputFile& in_;
  std::string_view rest_;
};

}  // namespace lacuna::io
