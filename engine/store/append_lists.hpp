// SPDX-License-Identifier: Apache-2.0
// Many append-only lists of records, mostly one per tile. Together they may be larger than memory.
//
// Each list has a buffer in memory. When the pool of all buffers is full, the fullest are written to the end
// of the one file, which is made then. Each becomes an extent of its list. So the file is written in long
// runs, whatever the order of appends. On disk, each extent begins with the place of the list's extent before
// it. So in memory a list is its buffer and 48 bytes, however many extents it has.
//
// The order of records within a list depends on threads and memory: a reader sorts them by what they hold.
// Only where one thread at a time appends to a list, `read` returns them in the order of the calls.
#pragma once

#include "engine/model/tiling.hpp"
#include "engine/run/memory.hpp"
#include "engine/store/store_file.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lacuna {

class AppendBytes final : BufferPool::Buffers {
 public:
  // Memory: a part of the pool, and in any case 64 KiB.
  AppendBytes(const Spill& spill, std::string_view name, std::size_t lists);
  ~AppendBytes();

  // Adds empty lists behind the others. May be called while other threads append.
  void add_lists(std::size_t count);
  // Appends bytes to a list. May be called from any thread; the bytes of one call stay together.
  void append(std::size_t list, std::span<const std::byte> bytes);
  std::uint64_t size(std::size_t list) const;  // bytes appended so far
  std::size_t lists() const { return lists_.size(); }
  // Reads a list, not while others append to it. `to` has `size(list)` bytes.
  void read(std::size_t list, std::byte* to) const;
  // Calls visit(block) with all bytes of a list, in any order, at most `block_bytes` at a time.
  void for_each_block(std::size_t list, std::size_t block_bytes,
                      const std::function<void(std::span<const std::byte>)>& visit) const;
  // Frees the list's buffer; its contents are gone.
  void drop(std::size_t list);

 private:
  struct Extent {
    std::uint64_t offset = 0, size = 0;  // size 0: no extent
  };
  struct List {
    std::vector<std::byte> buffer;  // empty, or space for an Extent and then what was appended
    Extent last;                    // the latest on disk
    std::uint64_t size = 0;

    std::span<const std::byte> tail() const {
      return std::span(buffer).subspan(std::min(buffer.size(), sizeof(Extent)));
    }
  };
  template <class TakeTail, class TakeExtent>
  void walk(std::size_t list, TakeTail&& take_tail, TakeExtent&& take_extent) const;
  void add_to_buffer(std::size_t index, std::span<const std::byte> bytes);
  void write_half() override;
  void write_out(List& list);

  std::shared_ptr<BufferPool> pool_;
  std::filesystem::path path_;
  std::optional<StoreFile> file_;  // from the first buffer on that did not fit
  std::vector<List> lists_;
  mutable std::mutex mutex_;  // not held while extents are read
};

template <class Record>
class AppendLists {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  AppendLists(const Spill& spill, std::string_view name, std::size_t lists)
      : bytes_(std::make_unique<AppendBytes>(spill, name, lists)) {}

  void append(std::size_t list, std::span<const Record> records) {
    if (!records.empty()) bytes_->append(list, std::as_bytes(records));
  }
  void append(std::size_t list, const Record& record) { append(list, std::span(&record, 1)); }
  std::uint64_t count(std::size_t list) const { return bytes_->size(list) / sizeof(Record); }
  std::size_t lists() const { return bytes_->lists(); }
  std::vector<Record> read(std::size_t list) const {
    std::vector<Record> records(count(list));
    bytes_->read(list, reinterpret_cast<std::byte*>(records.data()));
    return records;
  }
  // Calls visit(record) for each record, in any order, with only some of them in memory.
  template <class Visit>
  void for_each(std::size_t list, Visit&& visit) const {
    bytes_->for_each_block(list, sizeof(Record) << 14, [&](std::span<const std::byte> block) {
      const auto* const records = reinterpret_cast<const Record*>(block.data());
      for (const Record& record : std::span(records, block.size() / sizeof(Record))) visit(record);
    });
  }
  void drop(std::size_t list) { bytes_->drop(list); }

 private:
  std::unique_ptr<AppendBytes> bytes_;
};

// Gathers records by the tile that they are for: a list takes few long runs better than many short ones. Not
// from several threads at once; several outboxes may write to the same lists. Memory: 16,384 records.
template <class Record>
class Outbox {
 public:
  explicit Outbox(AppendLists<Record>& lists) : lists_(lists) {}

  void add(TileIndex to, const Record& record) {
    constexpr std::size_t kMost = 1 << 14;
    outbox_[to].push_back(record);
    if (++gathered_ == kMost) send();
  }

  // Sends the gathered records, and at the end the rest.
  void send() {
    for (const auto& [to, records] : outbox_) lists_.append(to, records);
    outbox_.clear();
    gathered_ = 0;
  }

 private:
  AppendLists<Record>& lists_;
  std::map<TileIndex, std::vector<Record>> outbox_;
  std::size_t gathered_ = 0;
};

}  // namespace lacuna
