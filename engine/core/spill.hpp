// Many append-only lists of records that together may be larger than memory.
//
// Each list has a buffer in memory. When all buffers together reach the budget, the fullest are written to
// the end of the one file, each as an extent of its list, until half of the budget is free. So the file is
// written in long runs, whatever the order of appends, and memory stays within the budget. Reading a list
// gathers its extents and what is still in its buffer. The order of records within a list depends on threads
// and budget: a reader sorts them by what they hold.
#pragma once

#include "engine/core/file.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <type_traits>
#include <vector>

namespace lacuna {

class SpillBytes {
 public:
  SpillBytes(std::filesystem::path path, std::size_t lists, std::uint64_t budget);

  // May be called from any thread; the bytes of one call stay together.
  void append(std::size_t list, std::span<const std::byte> bytes);
  std::uint64_t size(std::size_t list) const;  // bytes appended so far
  std::size_t lists() const { return lists_.size(); }
  // Not while others append to the same list.
  void read(std::size_t list, std::byte* to) const { read(list, 0, size(list), to); }
  void read(std::size_t list, std::uint64_t from, std::uint64_t bytes, std::byte* to) const;
  // Frees the list's buffer; what it held is gone.
  void drop(std::size_t list);

 private:
  struct Extent {
    std::uint64_t offset, size;
  };
  struct List {
    std::vector<std::byte> buffer;
    std::vector<Extent> extents;
    std::uint64_t size = 0;
  };
  void write_out(List& list);
  void relieve();

  ScratchFile file_;
  std::uint64_t budget_;
  std::uint64_t buffered_ = 0;
  std::uint64_t end_ = 0;
  std::vector<List> lists_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
};

template <class Record>
class Spill {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  Spill(std::filesystem::path path, std::size_t lists, std::uint64_t budget)
      : bytes_(std::move(path), lists, budget) {}

  void append(std::size_t list, std::span<const Record> records) {
    if (!records.empty()) bytes_.append(list, std::as_bytes(records));
  }
  void append(std::size_t list, const Record& record) { append(list, std::span(&record, 1)); }
  std::uint64_t count(std::size_t list) const { return bytes_.size(list) / sizeof(Record); }
  std::size_t lists() const { return bytes_.lists(); }
  std::vector<Record> read(std::size_t list) const {
    std::vector<Record> records(count(list));
    bytes_.read(list, reinterpret_cast<std::byte*>(records.data()));
    return records;
  }
  // visit(record) for each, with only a part of them in memory.
  template <class Visit>
  void for_each(std::size_t list, Visit&& visit) const {
    constexpr std::uint64_t kPart = 1 << 14;
    std::vector<Record> part;
    for (std::uint64_t from = 0; from < count(list); from += part.size()) {
      part.resize(std::min(kPart, count(list) - from));
      bytes_.read(list, from * sizeof(Record), part.size() * sizeof(Record),
                  reinterpret_cast<std::byte*>(part.data()));
      for (const Record& record : part) visit(record);
    }
  }
  void drop(std::size_t list) { bytes_.drop(list); }

 private:
  SpillBytes bytes_;
};

}  // namespace lacuna
