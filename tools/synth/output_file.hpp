// A file that appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace lacuna::synth {

// Writes NAME.partial through one large buffer; `commit` renames it to NAME. Without `commit` the partial
// file is removed. Every failure (no folder, no permission, a full disk) is an `Error` that names file and
// reason.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path name);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::span<const std::byte> bytes) {
    if (bytes.size() > buffer_.size() - used_) make_room(bytes.size());
    std::memcpy(buffer_.data() + used_, bytes.data(), bytes.size());
    used_ += bytes.size();
  }
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }

  // Puts `text` over the first bytes of the file.
  void overwrite_start(std::string_view text);

  // All bytes are in the partial file, so that `commit` of one file cannot fail for want of room after that
  // of another. Nothing may be written any more.
  void finish();
  // Finishes, and gives the file its name.
  void commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void make_room(std::size_t size);
  void flush();
  [[noreturn]] void fail() const;

  std::filesystem::path name_, partial_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0;
  bool committed_ = false;
};

}  // namespace lacuna::synth
