// SPDX-License-Identifier: Apache-2.0
// The data that the steps behind the evaluation need of the tiles: named streams of plain records.
//
// Nothing else is left of an evaluated tile: the neighbour graph never touches the disk. The global steps
// read the streams tile by tile. A run buffers them in memory, and spills what does not fit to one file
// without a name. A run that keeps its parts gathers tiles in parts. It seals one from time to time, so that
// a stop loses the tiles of the last seconds. No other process gives the same name to a part, so several may
// evaluate tiles of one level. Two outputs of one tile do no harm: they are the same.
#pragma once

#include "engine/model/tiling.hpp"
#include "engine/parts/parts.hpp"
#include "engine/store/append_lists.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lacuna {

// The name of a stream, at most 23 characters, and the type of its records.
template <class Record>
struct RecordStream {
  static_assert(std::is_trivially_copyable_v<Record>);
  std::string_view name;
};

// The output of one tile, while its consumers put their records into it.
class TileOutput {
 public:
  // `stream`: a stream that was not added before.
  template <class Record>
  void add(const RecordStream<Record>& stream, std::vector<Record> records) {
    if (records.empty()) return;
    const auto kept = std::make_shared<std::vector<Record>>(std::move(records));
    streams_.push_back({stream.name, std::as_bytes(std::span(*kept)), kept});
  }

 private:
  friend class TileOutputs;
  struct Stream {
    std::string_view name;
    std::span<const std::byte> bytes;
    std::shared_ptr<void> records;  // that have these bytes
  };

  std::vector<Stream> streams_;
};

// The outputs of all tiles of a level. Tiles are added from any thread. A stream is read after `finish`.
class TileOutputs {
 public:
  // `key`: of the parts that are kept. `tiling` must outlive this.
  TileOutputs(const Tiling& tiling, const Parts& parts, PartKey key, const Spill& spill);

  // Returns the tiles whose outputs are not there yet, ascending.
  std::vector<TileIndex> missing() const;
  void add(TileIndex tile, const TileOutput& output);
  void finish();  // seals the last part

  // Returns records in the order in which they were added. Throws `Error` where a sealed stream is broken.
  template <class Record>
  std::vector<Record> read(const RecordStream<Record>& stream, TileIndex tile) const {
    std::vector<Record> records(count(stream, tile));
    read_bytes(stream.name, tile, std::as_writable_bytes(std::span(records)));
    return records;
  }
  template <class Record>
  std::uint64_t count(const RecordStream<Record>& stream, TileIndex tile) const {
    return record_count(stream.name, tile, sizeof(Record));
  }

 private:
  static constexpr std::size_t kUnknown = SIZE_MAX;
  using Clock = std::chrono::steady_clock;

  // Where outputs are kept.
  struct Kept {
    std::filesystem::path folder;
    PartKey key;
    Clock::duration least_age;  // of a part, unless it is large
    Clock::time_point start = Clock::now();
    // By tile: the part that has its output; null: there is no output.
    std::vector<std::shared_ptr<const PartReader>> part_of;
    std::filesystem::path open_path;  // of the open part
    std::optional<PartWriter> open;
    Clock::time_point begun;  // when the open part was begun

    void find_parts(const Parts& parts);
    bool take(const std::filesystem::path& file);  // returns whether it is a part of these tiles
    void add(TileIndex tile, std::span<const TileOutput::Stream> streams);
    void seal();
  };

  std::size_t list_of(std::string_view stream, TileIndex tile) const;
  std::size_t make_list(std::string_view stream, TileIndex tile);
  std::uint64_t record_count(std::string_view stream, TileIndex tile, std::size_t record_bytes) const;
  void read_bytes(std::string_view stream, TileIndex tile, std::span<std::byte> to) const;

  const Tiling* tiling_;
  std::optional<Kept> kept_;
  // Where they are not kept: a list for each stream and tile, stream by stream.
  std::vector<std::string_view> streams_;
  std::unique_ptr<AppendBytes> lists_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // of new streams, or the open part
};

}  // namespace lacuna
