// Files of the workspace: positioned reads and writes, every one checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace lacuna {

// A scratch file, created empty. Reads and writes may come from several threads. Throws `Error`.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path path);
  ~ScratchFile();  // removes the file
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  // Bytes that were never written read as 0.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  int descriptor() const { return descriptor_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_;
};

// One record of plain data per row, in a file.
template <class Record>
class Column {
 public:
  explicit Column(std::filesystem::path path) : file_(std::move(path)) {}

  void write(std::uint64_t row, std::span<const Record> records) {
    file_.write(row * sizeof(Record), std::as_bytes(records));
  }
  void read(std::uint64_t row, std::span<Record> records) const {
    file_.read(row * sizeof(Record), std::as_writable_bytes(records));
  }
  std::vector<Record> read(std::uint64_t row, std::size_t count) const {
    std::vector<Record> records(count);
    read(row, std::span(records));
    return records;
  }

 private:
  ScratchFile file_;
};

}  // namespace lacuna
