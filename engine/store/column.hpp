// SPDX-License-Identifier: Apache-2.0
// One record of plain data per row, on disk; written at any row, or appended one at a time.
#pragma once

#include "engine/store/digest.hpp"
#include "engine/store/store_file.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <type_traits>
#include <vector>

namespace lacuna {

// Reads and writes may come from several threads, but no read of a row while it is written.
template <class Record>
class Column {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  explicit Column(std::filesystem::path path) : file_(std::move(path)) {}
  explicit Column(StoreFile file) : file_(std::move(file)) {}

  void write(std::uint64_t row, std::span<const Record> records) {
    file_.write(row * sizeof(Record), std::as_bytes(records));
  }
  // Writes behind all records that were appended before, and returns the row of the first new one. A column
  // is either appended to or written by row.
  std::uint64_t append(std::span<const Record> records) {
    return file_.append(std::as_bytes(records)) / sizeof(Record);
  }
  std::uint64_t size() const { return file_.size() / sizeof(Record); }  // rows, up to the last one written

  // Reads rows below `size()`. Rows in between that were never written are zeros.
  void read(std::uint64_t row, std::span<Record> records) const {
    file_.read(row * sizeof(Record), std::as_writable_bytes(records));
  }
  std::vector<Record> read(std::uint64_t row, std::size_t count) const {
    std::vector<Record> records(count);
    read(row, std::span(records));
    return records;
  }

  Digest digest(std::uint64_t row, std::uint64_t count) const {  // of the bytes of some rows
    return digest_of(file_, row * sizeof(Record), count * sizeof(Record));
  }

  StoreFile& file() { return file_; }
  const StoreFile& file() const { return file_; }

 private:
  StoreFile file_;
};

// Reads records of rows in mostly ascending order, in runs: for a few here and there.
template <class Record>
class ColumnReader {
 public:
  explicit ColumnReader(const Column<Record>& column) : column_(column) {}

  const Record& operator[](std::uint64_t row) {
    constexpr std::uint64_t kRun = 256, kLongRun = 4096;  // the longer, while rows ascend one by one
    if (row < first_ || row >= first_ + run_.size()) {
      assert(row < column_.size());
      const bool goes_on = !run_.empty() && row == first_ + run_.size();
      first_ = row;
      run_.resize(std::min(goes_on ? kLongRun : kRun, column_.size() - row));
      column_.read(row, std::span(run_));
    }
    return run_[row - first_];
  }

 private:
  const Column<Record>& column_;
  std::uint64_t first_ = 0;
  std::vector<Record> run_;
};

// Writes some thousand records together. The last ones are written by `finish`, which has to be called.
template <class Record>
class ColumnWriter {
 public:
  explicit ColumnWriter(Column<Record>& column) : column_(column) {}

  void add(const Record& record) {
    block_.push_back(record);
    if (block_.size() == kTogether) finish();
  }
  void finish() {
    column_.append(block_);
    block_.clear();
  }

 private:
  static constexpr std::size_t kTogether = 4096;

  Column<Record>& column_;
  std::vector<Record> block_;
};

}  // namespace lacuna
