// SPDX-License-Identifier: Apache-2.0
// A file that is being written, through one buffer or by another library. Every failure of the disk is an
// `Error` with the file's name.
#pragma once

#include "engine/store/temporary_folder.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace lacuna::io {

// The writer of the bytes: this class, or a library that makes the file, or makes none.
enum class Writer { kThis, kLibrary };

class OutputFile {
 public:
  // Makes the new file `place`, or leaves that to the library. Errors call it `name`: the path that it will
  // have in the end.
  OutputFile(std::filesystem::path name, const std::filesystem::path& place, Writer writer = Writer::kThis);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return name_; }
  const std::filesystem::path& place() const { return place_; }

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  // Puts bytes over the written bytes from `at` on, such as a count known at the end.
  void overwrite(std::uint64_t at, std::span<const std::byte> bytes);
  void overwrite_start(std::string_view text) { overwrite(0, std::as_bytes(std::span(text))); }

  // Afterwards all bytes are on the disk, and nothing can be written any more. Returns false if the library
  // has made no file.
  bool close();

 private:
  void flush();
  void put(std::uint64_t at, std::span<const std::byte> bytes);
  [[noreturn]] void fail(const char* what, int reason) const;

  std::filesystem::path name_, place_;
  Writer writer_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;  // of what is in the file; the buffer follows
  std::vector<std::byte> buffer_;
};

// A file that takes its name only once it is complete.
//
// The name may be free, or the name of an own file: a regular file that the same command has written, which
// its mark shows. With Overwrite::kAny it may be the name of any regular file. Links, folders, pipes and
// devices are refused. The content goes to a private folder next to the name first. A failure leaves the name
// as it was.

enum class Overwrite { kOwn, kAny };

// The proof that an earlier run of a command wrote a file: a text at a byte of it.
struct FileMark {
  FileMark(std::string_view text, std::uint64_t offset = 0) : text(text), offset(offset) {}
  FileMark(const char* text) : text(text) {}

  std::string_view text;
  std::uint64_t offset = 0;
};

// Throws `Error` if a file of this name may not be written. Cheap, for a program to check before the work.
void check_output(const std::filesystem::path& file, const FileMark& mark, Overwrite overwrite);

class NewFile {
 public:
  // Checks the name, and opens the content.
  NewFile(const std::filesystem::path& file, const FileMark& mark, Overwrite overwrite);

  OutputFile& content() { return content_; }

  // Closes the content, and gives it the name. Throws `Error` if a file has come to the name meanwhile that
  // may not be replaced.
  void commit();

 private:
  std::filesystem::path file_;
  FileMark mark_;
  Overwrite overwrite_;
  TemporaryFolder folder_;
  OutputFile content_;
};

}  // namespace lacuna::io
