// What the steps behind the evaluation need of one tile: named streams of plain records.
//
// It is all that is left of an evaluated tile: the neighbour graph never touches the disk. A run whose
// workspace is kept seals outputs in parts, so that no tile is evaluated twice.
#pragma once

#include "engine/run/error.hpp"
#include "engine/store/sealed_part.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>
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

class TileOutput {
 public:
  TileOutput() = default;
  // One that was sealed: each stream is read when it is wanted. The part must outlive it.
  TileOutput(const PartReader& part, std::uint64_t tile) : part_(&part), tile_(tile) {}

  // A stream that was not added before.
  template <class Record, class Allocator>
  void add(std::string_view stream, std::vector<Record, Allocator> records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    if (records.empty()) return;
    const auto owned = std::make_shared<const std::vector<Record, Allocator>>(std::move(records));
    const bool is_new =
        streams_.try_emplace(std::string(stream), std::as_bytes(std::span(*owned)), owned).second;
    assert(is_new);
    static_cast<void>(is_new);
  }

  // All records of the stream, in their order; none where nothing was added.
  template <class Record>
  std::span<const Record> read(std::string_view stream) const {
    static_assert(std::is_trivially_copyable_v<Record>);
    const std::span<const std::byte> bytes = bytes_of(stream);
    if (bytes.size() % sizeof(Record) != 0) fail_record_size(stream);
    assert(reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(Record) == 0);
    return {reinterpret_cast<const Record*>(bytes.data()), bytes.size() / sizeof(Record)};
  }

  // visit(stream, bytes)
  template <class Visit>
  void for_each_stream(Visit&& visit) const {
    for (const auto& [name, stream] : streams_) visit(name, stream.bytes);
  }

 private:
  struct Stream {
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> owner;
  };
  std::span<const std::byte> bytes_of(std::string_view stream) const {
    const auto at = streams_.find(stream);
    if (at != streams_.end()) return at->second.bytes;
    if (part_ == nullptr) return {};
    const auto owned = std::make_shared<const PartReader::AlignedBytes>(part_->bytes(stream, tile_));
    return streams_.try_emplace(std::string(stream), std::span(*owned), owned).first->second.bytes;
  }
  [[noreturn]] static void fail_record_size(std::string_view stream) {
    fail_inconsistent("the stream " + std::string(stream) + " of a tile is not of whole records");
  }

  mutable std::map<std::string, Stream, std::less<>> streams_;  // in memory
  const PartReader* part_ = nullptr;
  std::uint64_t tile_ = 0;  // of the part
};

}  // namespace lacuna
