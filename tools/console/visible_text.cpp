// SPDX-License-Identifier: Apache-2.0
#include "tools/console/visible_text.hpp"

#include "engine/run/utf8.hpp"

#include <algorithm>
#include <cerrno>
#include <iostream>
#include <streambuf>

namespace lacuna::tools {
namespace {

void append_hexadecimal(std::string& text, unsigned char byte) {
  constexpr char kDigits[] = "0123456789abcdef";
  text += kDigits[byte >> 4];
  text += kDigits[byte & 15];
}

int first_failure = 0;

bool succeeded(bool is_done) {
  if (!is_done && first_failure == 0) first_failure = errno;
  return is_done;
}

// Collects whole lines, so that no character is cut.
class VisibleBuffer final : public std::streambuf {
 public:
  explicit VisibleBuffer(std::FILE* file) : file_(file) {}

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char character = traits_type::to_char_type(c);
    return xsputn(&character, 1) == 1 ? c : traits_type::eof();
  }
  std::streamsize xsputn(const char* from, std::streamsize count) override {
    const std::string_view more(from, static_cast<std::size_t>(count));
    const std::size_t line_end = more.rfind('\n');  // in these alone: a line may come in many pieces
    const std::size_t before = text_.size();
    text_ += more;
    if (line_end == std::string_view::npos || text_.size() < kEnough) return count;
    return write(before + line_end + 1) ? count : 0;
  }
  int sync() override { return write(text_.size()) && succeeded(std::fflush(file_) == 0) ? 0 : -1; }

 private:
  static constexpr std::size_t kEnough = std::size_t{1} << 16;

  bool write(std::size_t count) {
    std::string shown;
    std::string_view left = std::string_view(text_).substr(0, count);
    while (!left.empty()) {
      const std::size_t length = std::min(left.find_first_of("\n\t"), left.size());
      shown += visible(left.substr(0, length));
      if (length < left.size()) shown += left[length];
      left.remove_prefix(std::min(length + 1, left.size()));
    }
    text_.erase(0, count);
    return succeeded(std::fwrite(shown.data(), 1, shown.size(), file_) == shown.size());
  }

  std::FILE* file_;
  std::string text_;
};

}  // namespace

std::string visible(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      append_hexadecimal(shown += "\\x", static_cast<unsigned char>(text.front()));
    } else if (is_control(text.substr(0, length))) {
      append_hexadecimal(shown += "\\u00", static_cast<unsigned char>(text[length - 1]));
    } else {
      shown += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return shown;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kBegin = 600, kEnd = 300;
  if (text.size() <= kBegin + kEnd) return text;
  const auto begin_of_character = [&](std::size_t at) {
    while ((static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;
    return at;
  };
  return text.substr(0, begin_of_character(kBegin)) + " ... " +
         text.substr(begin_of_character(text.size() - kEnd));
}

void show_output_visibly(std::FILE* file) {
  static auto* const buffer =
      new VisibleBuffer(file);  // never destroyed: std::cout is flushed at the very end
  std::cout.rdbuf(buffer);
}

int output_failure() {
  return first_failure;
}

}  // namespace lacuna::tools
