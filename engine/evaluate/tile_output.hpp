// SPDX-License-Identifier: Apache-2.0
// What the steps behind the evaluation need of one tile: named streams of plain records.
//
// It is all that is left of an evaluated tile: the neighbour graph never touches the disk. A run whose
// workspace is kept seals outputs in parts, so that no tile is evaluated twice. In a part, a row is the number
// of a tile and a place in it. So an output stays right where other tiles get more or fewer points.
#pragma once

#include "engine/model/tiling.hpp"
#include "engine/run/error.hpp"
#include "engine/store/sealed_part.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lacuna {

// for_each_row(record, visit): visit(row) for each row of a record of a stream, by reference.
template <class Visit>
void for_each_row(Row& row, Visit&& visit) {
  visit(row);
}
template <class Record>
concept HasRows = requires(Record& record) {
  for_each_row(record, [](Row&) {});
};

// How a part has a row, and back. The latter throws `Error` where the tile has no such row.
Row to_stored_row(Row row, const Tiling& tiling);
Row from_stored_row(Row stored, const Tiling& tiling);

// All that the output of a tile depends on, save for the config: its points and those around it.
using TileContent = Digest;

class TileOutput {
 public:
  TileOutput() = default;
  // One that was sealed: each stream is read when it is wanted. Part and tiling must outlive it.
  TileOutput(const PartReader& part, std::uint64_t tile, const Tiling& tiling)
      : part_(&part), tile_(tile), tiling_(&tiling) {}

  // A stream that was not added before.
  template <class Record, class Allocator>
  void add(std::string_view stream, std::vector<Record, Allocator> records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    if (records.empty()) return;
    const auto owned = std::make_shared<const std::vector<Record, Allocator>>(std::move(records));
    StoreRows store_rows = nullptr;
    if constexpr (HasRows<Record>) store_rows = store_rows_of<Record>;
    const bool is_new =
        streams_.try_emplace(std::string(stream), std::as_bytes(std::span(*owned)), owned, store_rows).second;
    assert(is_new);
    static_cast<void>(is_new);
  }

  void set_content(const TileContent& content) { add("content", std::vector{content}); }
  TileContent content() const {
    const std::span<const TileContent> content = read<TileContent>("content");
    return content.empty() ? TileContent{} : content.front();
  }

  // All records of the stream, in their order; none where nothing was added.
  template <class Record>
  std::span<const Record> read(std::string_view stream) const {
    static_assert(std::is_trivially_copyable_v<Record>);
    const std::span<const std::byte> bytes = bytes_of<Record>(stream);
    if (bytes.size() % sizeof(Record) != 0) fail_record_size(stream);
    assert(reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(Record) == 0);
    return {reinterpret_cast<const Record*>(bytes.data()), bytes.size() / sizeof(Record)};
  }

  // visit(stream, bytes), as a part has them. `tiling`: of the level.
  template <class Visit>
  void for_each_stored(const Tiling& tiling, Visit&& visit) const {
    if (part_ != nullptr) {
      for (const std::string& stream : part_->streams(tile_)) visit(stream, part_->bytes(stream, tile_));
      return;
    }
    std::vector<std::byte> stored;
    for (const auto& [name, stream] : streams_) {
      if (stream.store_rows == nullptr) {
        visit(name, stream.bytes);
      } else {
        stored.assign(stream.bytes.begin(), stream.bytes.end());
        stream.store_rows(stored, tiling);
        visit(name, stored);
      }
    }
  }

 private:
  using StoreRows = void (*)(std::span<std::byte> records, const Tiling& tiling);
  struct Stream {
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> owner;
    StoreRows store_rows;  // null: it has none
  };

  template <class Record, class Convert>
  static void convert_rows(std::span<std::byte> records, Convert&& convert) {
    for (; records.size() >= sizeof(Record); records = records.subspan(sizeof(Record))) {
      Record record;
      std::memcpy(&record, records.data(), sizeof record);
      for_each_row(record, [&](Row& row) { row = convert(row); });
      std::memcpy(records.data(), &record, sizeof record);
    }
  }
  template <class Record>
  static void store_rows_of(std::span<std::byte> records, const Tiling& tiling) {
    convert_rows<Record>(records, [&](Row row) { return to_stored_row(row, tiling); });
  }

  template <class Record>
  std::span<const std::byte> bytes_of(std::string_view stream) const {
    const auto at = streams_.find(stream);
    if (at != streams_.end()) return at->second.bytes;
    if (part_ == nullptr) return {};
    const auto owned = std::make_shared<PartReader::AlignedBytes>(part_->bytes(stream, tile_));
    if constexpr (HasRows<Record>)
      convert_rows<Record>(*owned, [&](Row row) { return from_stored_row(row, *tiling_); });
    return streams_.try_emplace(std::string(stream), std::span(*owned), owned, nullptr).first->second.bytes;
  }
  [[noreturn]] static void fail_record_size(std::string_view stream) {
    fail_inconsistent("the stream " + std::string(stream) + " of a tile is not of whole records");
  }

  mutable std::map<std::string, Stream, std::less<>> streams_;  // in memory
  const PartReader* part_ = nullptr;
  std::uint64_t tile_ = 0;  // of the part
  const Tiling* tiling_ = nullptr;
};

}  // namespace lacuna
