// SPDX-License-Identifier: Apache-2.0
// The outputs of a level's tiles in a workspace.
//
// Outputs gather in a part, which is sealed from time to time. So a run that is stopped loses the tiles of
// the last seconds. No other process gives the same name to a part. So several processes may evaluate tiles
// of one level at a time. Two outputs of one tile do no harm: they are the same.
#pragma once

#include "engine/model/tiling.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/workspace/workspace.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

class KeptOutputs {
 public:
  // Records of one tile, as the part has them.
  struct Stream {
    std::string_view name;
    std::span<const std::byte> bytes;
  };

  // Finds the sealed outputs of a level that are made from `made_from`.
  KeptOutputs(std::size_t level, std::size_t tiles, const std::string& made_from, const Workspace& workspace);

  std::vector<TileIndex> missing() const;  // tiles without a sealed output, ascending

  // Adds the output of a tile. From any thread.
  void add(TileIndex tile, std::span<const Stream> streams);
  // Seals the last outputs. After that, outputs are read, from any thread.
  void finish();

  // Returns the bytes of a stream; 0 where the tile has no such stream.
  std::uint64_t size(std::string_view stream, TileIndex tile) const;
  void read(std::string_view stream, TileIndex tile, std::span<std::byte> to) const;  // all of them

 private:
  using Clock = std::chrono::steady_clock;
  // By tile: the part that has its output; null: there is no output.
  using PartOfTile = std::vector<std::shared_ptr<const PartReader>>;

  void find_parts(bool is_unit);
  void seal();

  std::size_t level_;
  std::filesystem::path folder_;
  Digest made_from_;
  PartOfTile part_of_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // of the open part
  std::filesystem::path open_path_;                                     // of the open part
  std::optional<PartWriter> open_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point begun_;    // when the open part was begun
  Clock::duration least_age_;  // of a part, unless it is large
};

}  // namespace lacuna
