// What the steps behind the evaluation need of one tile: named streams of plain records.
//
// It is all that is left of an evaluated tile: the neighbour graph never touches the disk. A run whose
// workspace is kept seals outputs in parts, so that no tile is evaluated twice.
#pragma once

#include "engine/run/error.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <oneapi/tbb/cache_aligned_allocator.h>

namespace lacuna {

class TileOutput {
 public:
  static constexpr std::size_t kAlignment = 64;
  using Bytes = std::vector<std::byte, tbb::cache_aligned_allocator<std::byte>>;

  // Appends to the stream.
  template <class Record>
  void add(std::string_view stream, std::span<const Record> records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    const std::span<const std::byte> bytes = std::as_bytes(records);
    if (bytes.empty()) return;
    Bytes& to = streams_.try_emplace(std::string(stream)).first->second;
    to.insert(to.end(), bytes.begin(), bytes.end());
  }
  template <class Record>
  void add(std::string_view stream, const std::vector<Record>& records) {
    add(stream, std::span<const Record>(records));
  }

  // All records of the stream, in their order; none where nothing was added.
  template <class Record>
  std::span<const Record> read(std::string_view stream) const {
    static_assert(std::is_trivially_copyable_v<Record> && alignof(Record) <= kAlignment);
    const auto at = streams_.find(stream);
    if (at == streams_.end()) return {};
    if (at->second.size() % sizeof(Record) != 0) fail_record_size(stream);
    return {reinterpret_cast<const Record*>(at->second.data()), at->second.size() / sizeof(Record)};
  }

  const std::map<std::string, Bytes, std::less<>>& streams() const { return streams_; }

 private:
  [[noreturn]] static void fail_record_size(std::string_view stream) {
    fail_inconsistent("the stream " + std::string(stream) + " of a tile is not of whole records");
  }

  std::map<std::string, Bytes, std::less<>> streams_;
};

}  // namespace lacuna
