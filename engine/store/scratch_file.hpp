// A file of the workspace without a name: positioned reads and writes, every one checked.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace lacuna {

// Created empty, and its name removed at once: nobody else can open it, and the system frees it with the
// process, however that ends. Reads and writes may come from several threads.
//
// Throws `Error` when the disk is full or the file is shorter than what was written. It names the path at
// which the file was created, and the place in it. So it never returns zeros in place of what was written.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path path);  // `path` must not exist
  ~ScratchFile();
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&&) = delete;

  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  // Writes behind all that was appended before; returns the offset. A file is appended to or written at
  // offsets, not both.
  std::uint64_t append(std::span<const std::byte> bytes);
  // Up to `size()`. Bytes in between that were never written read as 0.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  std::uint64_t size() const { return size_; }                 // where the last write so far ends
  const std::filesystem::path& path() const { return path_; }  // where it was created
  // Reserves and maps `bytes` bytes of zeros, writable. The mapping outlives the file.
  std::byte* map(std::size_t bytes) const;

 private:
  void check_length() const;

  std::filesystem::path path_;
  int descriptor_;
  std::atomic<std::uint64_t> size_ = 0;      // of writes that are done
  std::atomic<std::uint64_t> appended_ = 0;  // with those that are not
};

}  // namespace lacuna
