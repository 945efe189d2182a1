// Files of the workspace: positioned reads and writes, every one checked.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace lacuna {

// A scratch file, created empty. Reads and writes may come from several threads. Throws `Error`.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path path);
  ~ScratchFile();  // removes the file
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&&) = delete;

  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  // Bytes that were never written read as 0.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  int descriptor() const { return descriptor_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_;
};

// One array of bytes in several scratch files, a stripe in each in turn: the system lets only one thread at a
// time write to a file. A file is created when it is first written to.
class StripedFile {
 public:
  explicit StripedFile(std::filesystem::path path) : path_(std::move(path)) {}

  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  // Bytes that were never written read as 0. Not while others write to the same part.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  static constexpr std::size_t kFiles = 8;
  struct Lazy {
    std::once_flag created;
    std::optional<ScratchFile> file;
  };
  std::filesystem::path path_;
  std::unique_ptr<std::array<Lazy, kFiles>> files_ = std::make_unique<std::array<Lazy, kFiles>>();
};

// One record of plain data per row, in files.
template <class Record>
class Column {
 public:
  explicit Column(std::filesystem::path path) : bytes_(std::move(path)) {}

  void write(std::uint64_t row, std::span<const Record> records) {
    bytes_.write(row * sizeof(Record), std::as_bytes(records));
  }
  void read(std::uint64_t row, std::span<Record> records) const {
    bytes_.read(row * sizeof(Record), std::as_writable_bytes(records));
  }
  std::vector<Record> read(std::uint64_t row, std::size_t count) const {
    std::vector<Record> records(count);
    read(row, std::span(records));
    return records;
  }

 private:
  StripedFile bytes_;
};

// A column that grows at its end, written in long runs. Appends may come from several threads.
template <class Record>
class GrowingColumn {
 public:
  explicit GrowingColumn(std::filesystem::path path) : column_(std::move(path)) {}

  // Returns the row of the first.
  std::uint64_t append(std::span<const Record> records) {
    const std::lock_guard lock(*mutex_);
    constexpr std::size_t kRun = 1 << 15;
    const std::uint64_t row = size();
    last_.insert(last_.end(), records.begin(), records.end());
    if (last_.size() >= kRun) {
      column_.write(written_, last_);
      written_ += last_.size();
      last_.clear();
    }
    return row;
  }
  std::uint64_t size() const { return written_ + last_.size(); }

  // Not while others append.
  std::vector<Record> read(std::uint64_t row, std::size_t count) const {
    std::vector<Record> records(count);
    const std::size_t before = row < written_ ? std::min<std::uint64_t>(count, written_ - row) : 0;
    column_.read(row, std::span(records).first(before));
    if (before < count) {
      const auto left = std::span(last_).subspan(row + before - written_, count - before);
      std::copy(left.begin(), left.end(), records.begin() + static_cast<std::ptrdiff_t>(before));
    }
    return records;
  }

 private:
  Column<Record> column_;
  std::uint64_t written_ = 0;
  std::vector<Record> last_;  // after those
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
};

// Records of rows in ascending order, read in runs: for a few here and there.
template <class Record>
class RunReader {
 public:
  explicit RunReader(const Column<Record>& column) : column_(column) {}

  const Record& operator[](std::uint64_t row) {
    constexpr std::size_t kRun = 256;
    if (run_.empty() || row >= first_ + run_.size()) {
      first_ = row;
      run_.resize(kRun);
      column_.read(row, std::span(run_));
    }
    return run_[row - first_];
  }

 private:
  const Column<Record>& column_;
  std::uint64_t first_ = 0;
  std::vector<Record> run_;
};

}  // namespace lacuna
