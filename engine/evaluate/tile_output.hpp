// What the steps behind the evaluation need of one tile: named streams of plain records.
//
// It is all that is left of an evaluated tile: the neighbour graph never touches the disk. A run whose
// workspace is kept seals outputs in parts, so that no tile is evaluated twice.
#pragma once

#include "engine/run/error.hpp"

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
    const auto at = streams_.find(stream);
    if (at == streams_.end()) return {};
    const std::span<const std::byte> bytes = at->second.bytes;
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
  [[noreturn]] static void fail_record_size(std::string_view stream) {
    fail_inconsistent("the stream " + std::string(stream) + " of a tile is not of whole records");
  }

  std::map<std::string, Stream, std::less<>> streams_;
};

}  // namespace lacuna
