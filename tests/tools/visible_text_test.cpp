// SPDX-License-Identifier: Apache-2.0
#include "tools/console/terminal.hpp"

#include "engine/run/utf8.hpp"
#include "tests/support/test.hpp"

namespace lacuna::tools {
namespace {

using namespace std::string_literals;

TEST_CASE("control characters are shown, not obeyed") {
  CHECK(visible("\033]0;pwned\a") == "\\u001b]0;pwned\\u0007");
  CHECK(visible("a\tb\nc\rd\177"s) == "a\\u0009b\\u000ac\\u000dd\\u007f");
  CHECK(visible("\0"s) == "\\u0000");
  CHECK(visible("\xc2\x9b"
                "2J \xc2\x80 \xc2\x9f") == "\\u009b2J \\u0080 \\u009f");
  CHECK(visible("\x9b"
                "2J") == "\\x9b2J");  // C1 as one byte
}

TEST_CASE("letters of any language stay as they are") {
  for (const std::string text :
       {"plain ~ text", "Größe", "点云.ply", "\xc2\xa0", "\xf0\x9f\x95\xb3", "a\\b"}) {
    CHECK(visible(text) == text);
  }
}

TEST_CASE("a long line keeps its begin and its end, and no character is cut") {
  CHECK(shortened("a.ply: short") == "a.ply: short");
  for (const std::string unit : {"x", "ö", "点", "\xf0\x9f\x95\xb3"}) {
    std::string text = "a.json: ";
    while (text.size() < 1'000'000) text += unit;
    const std::string line = shortened(text + ": is not allowed");
    CHECK(line.size() < 1000);
    CHECK(line.starts_with("a.json: " + unit));
    CHECK(line.ends_with(unit + ": is not allowed"));
    CHECK(visible(line) == line);
  }
}

TEST_CASE("bytes that are not UTF-8 are shown one by one, and the next character is found") {
  CHECK(visible("a\xff"
                "b") == "a\\xffb");
  CHECK(visible("\xe7\x82") == "\\xe7\\x82");  // cut
  CHECK(visible("\xe7\x82"
                "x") == "\\xe7\\x82x");
  CHECK(visible("\xc0\x9b") == "\\xc0\\x9b");  // overlong
  CHECK(visible("\xe0\x82\x9b") == "\\xe0\\x82\\x9b");
  CHECK(visible("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // a surrogate
  CHECK(visible("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // above U+10FFFF
}

TEST_CASE("every character that UTF-8 can hold is found with its length, and no other bytes") {
  for (char32_t c = 0; c < 0x120000; ++c) {
    std::string bytes;
    if (c < 0x80) {
      bytes.push_back(char(c));
    } else if (c < 0x800) {
      bytes = {char(0xc0 | c >> 6), char(0x80 | (c & 63))};
    } else if (c < 0x10000) {
      bytes = {char(0xe0 | c >> 12), char(0x80 | (c >> 6 & 63)), char(0x80 | (c & 63))};
    } else {
      bytes = {char(0xf0 | c >> 18), char(0x80 | (c >> 12 & 63)), char(0x80 | (c >> 6 & 63)),
               char(0x80 | (c & 63))};
    }
    const bool is_character = c < 0xd800 || (c > 0xdfff && c < 0x110000);
    if (utf8_length(bytes) != (is_character ? bytes.size() : 0)) FAIL("U+" << std::hex << std::uint32_t(c));
    if (bytes.size() > 1 && utf8_length(bytes.substr(0, bytes.size() - 1)) != 0)
      FAIL("cut: " << std::uint32_t(c));
  }
}

}  // namespace
}  // namespace lacuna::tools
