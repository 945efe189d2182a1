// A file that is being written, through one buffer. Every failure of the disk is an `Error` with the file's
// name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace lacuna {

class OutputFile {
 public:
  // Makes the new file `place`. `name` is what errors call it: the path that it will have in the end.
  OutputFile(std::filesystem::path name, const std::filesystem::path& place);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return name_; }

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  // Puts `text` over the first bytes of the file, which are written already: a count known at the end.
  void overwrite_start(std::string_view text);

  void close();  // all bytes are on the disk afterwards, and nothing can be written any more

 private:
  void flush();
  void put(std::uint64_t at, std::span<const std::byte> bytes);
  [[noreturn]] void fail(const char* what, int reason) const;

  std::filesystem::path name_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;  // of what is in the file; the buffer follows
  std::vector<std::byte> buffer_;
};

}  // namespace lacuna
