// SPDX-License-Identifier: Apache-2.0
// A file of the engine: positioned reads and writes, every one checked.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <unistd.h>

namespace lacuna {

// The number of an open file or folder, which is closed at the end. It is negative where opening failed.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  bool is_open() const { return number_ >= 0; }
  int number() const { return number_; }

 private:
  int number_ = -1;
};

inline constexpr const char* kUnsealed = ".partial";  // how names of files end before they are sealed
std::string random_digits();  // 16 hexadecimal digits, drawn at random: no other process has the same

// Reads and writes may come from several threads.
//
// Throws `Error` when the disk is full or the file is shorter than what was written. The error names the path
// at which the file was created, and the place in it. So a read never returns zeros in place of what was
// written.
class StoreFile {
 public:
  enum class Name {
    kRemoved,  // at once: nobody else can open it, and the system frees it with the process, however that
               // ends
    kKept,     // until it is sealed or closed
  };
  // Creates an empty file. `path` must not exist.
  explicit StoreFile(std::filesystem::path path, Name name = Name::kRemoved);
  // Opens a sealed file, to be read only. Returns nothing where there is no regular file. Throws `Error`.
  static std::optional<StoreFile> open_sealed(const std::filesystem::path& path);
  ~StoreFile();  // removes a file with a name that was not sealed
  StoreFile(StoreFile&& other) noexcept;
  StoreFile& operator=(StoreFile&&) = delete;

  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  // Writes behind all bytes that were appended before, and returns the offset. A file is either appended to
  // or written at offsets.
  std::uint64_t append(std::span<const std::byte> bytes);
  // Reads up to `size()`. Bytes in between that were never written read as 0.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  std::uint64_t size() const { return size_; }                 // where the last write so far ends
  const std::filesystem::path& path() const { return path_; }  // where it was created
  // Reserves and maps `bytes` bytes of zeros, writable. The mapping outlives the file.
  std::byte* map(std::size_t bytes) const;
  // Lets the system begin to bring the written bytes to the disk, so that sealing takes less time.
  void start_sync() const;
  // Brings all bytes of a file with a name to the disk, and then renames it. From then on it is only read.
  // A file of the new name is replaced.
  void seal(const std::filesystem::path& path);

 private:
  StoreFile(std::filesystem::path path, int descriptor, std::uint64_t size)
      : path_(std::move(path)), descriptor_(descriptor), size_(size) {}
  void check_length() const;

  std::filesystem::path path_;
  int descriptor_;
  bool has_own_name_ = false;                // to be removed
  std::atomic<std::uint64_t> size_ = 0;      // of writes that are done
  std::atomic<std::uint64_t> appended_ = 0;  // with those that are not
};

}  // namespace lacuna
