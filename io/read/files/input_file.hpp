// SPDX-License-Identifier: Apache-2.0
// A file read front to back through one buffer, by bytes, lines or words, whatever the format needs next. The
// buffer bounds the memory, so that a line without an end is an error.
#pragma once

#include "engine/store/digest.hpp"
#include "io/read/files/number.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace lacuna::io {

class InputFile {
 public:
  // Throws `Error` if the file is missing, not readable or not a regular file (it is read several times).
  // The buffer has `buffer_bytes`.
  explicit InputFile(std::filesystem::path file, std::size_t buffer_bytes = std::size_t{1} << 20);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& file() const { return file_; }
  std::uint64_t position() const { return end_position_ - (end_ - begin_); }
  std::uint64_t remaining() const;
  std::uint64_t line() const { return line_; }  // lines passed, by next_line and next_row

  // Returns the next bytes without passing them: `count` or, at the end of the file, fewer; at most the
  // buffer's size.
  std::string_view peek(std::size_t count);
  // Throws `Error` if the file ends before.
  void read(std::byte* to, std::size_t count);
  void skip(std::uint64_t count);
  // Reads bytes from anywhere in the file; the next read goes on at the same place.
  void read_at(std::uint64_t place, std::span<std::byte> to) const;

  // Makes lines end with a carriage return alone if the first one does. Must be called at the beginning of
  // the file.
  void accept_lone_returns();

  // Returns the next line without its end (LF or CR LF), valid until the next call; empty at the end of the
  // file.
  std::optional<std::string_view> next_line();

  // These read words of lines, however long the line. `next_row` passes blank lines, and returns false at the
  // end of the file. `next_word` is valid until the next call, and returns nothing at the end of the line.
  // `end_row` passes the line's end, and returns false if a word is left before it.
  bool next_row();
  std::optional<std::string_view> next_word();
  bool end_row();

  [[noreturn]] void fail(const std::string& reason) const;
  [[noreturn]] void fail_at_line(std::uint64_t line, const std::string& reason) const;
  [[noreturn]] void fail_at_byte(std::uint64_t byte, const std::string& reason) const;

 private:
  bool fill();  // more bytes into the buffer behind those not yet passed; false at the end of the file
  void pass_blanks();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::size_t buffer_bytes_;
  std::unique_ptr<char[]> buffer_;  // not set to zero: a small file touches little of it
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t end_position_ = 0;  // in the file, of the buffer's end
  std::uint64_t line_ = 0;
  char line_end_ = '\n';
};

// Which number of points holds where a file's header counts others than the file has.
enum class Trust : std::uint8_t { kNeither, kHeader, kFile };

inline constexpr std::string_view kBlanks = " \t\r\n\v\f";

// Throws `Error` if more than `padding` is left: rows that the header does not count would be lost.
void require_end(InputFile& in, std::string_view padding = kBlanks);

// Returns text from a file for an error message: one line, printable, not long, in quotes.
std::string in_quotes(std::string_view text);

// The words of one line of a text format, taken one after the other.

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

// Whether a file is still the one that was read before, with the same content.

struct FileState {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t size = 0;  // bytes
  std::int64_t mtime = 0;  // nanoseconds since 1970, as ctime
  std::int64_t ctime = 0;  // of the last change to content, name, owner or permissions; no program sets it
};

// Returns device and inode of what a name stands for; nothing if there is nothing.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;
std::optional<FileIdentity> find_identity(const std::filesystem::path& file);

// Throws `Error` if there is no such file.
FileState file_state(const std::filesystem::path& file);

// Returns the digest of some blocks spread over the file, with the first and the last. Throws `Error`.
Digest sample_digest(const std::filesystem::path& file, const FileState& state);

// Throws `Error`, with the difference, unless the file has the state that it had `before`. The check misses
// content of the same length that is written within the clock tick of `before` (milliseconds).
void check_unchanged(const std::filesystem::path& file, const FileState& before);

}  // namespace lacuna::io
