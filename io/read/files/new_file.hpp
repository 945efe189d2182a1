// SPDX-License-Identifier: Apache-2.0
// A file that takes its name only once it is complete.
//
// The name may be free, or the name of an own file: a regular file that the same command has written, which
// its mark shows. With Overwrite::kAny it may be the name of any regular file. Links, folders, pipes and
// devices are refused. The content goes to a private folder next to the name first. A failure leaves the name
// as it was.
#pragma once

#include "engine/store/temporary_folder.hpp"
#include "io/read/files/output_file.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace lacuna::io {

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
