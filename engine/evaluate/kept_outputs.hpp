// SPDX-License-Identifier: Apache-2.0
// The outputs of a level's tiles in a workspace that is kept.
//
// Outputs gather in a part, which is sealed from time to time. So a run that is stopped loses the tiles of
// the last seconds. Parts have names that no other process gives to one, so several may put out tiles of one
// level at a time. A tile of which there are two outputs does no harm: they are the same.
#pragma once

#include "engine/evaluate/tile_output.hpp"
#include "engine/model/tiling.hpp"
#include "engine/run/job.hpp"
#include "engine/store/sealed_part.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

class KeptOutputs {
 public:
  // Finds the sealed outputs that are whole and made from this. Where no workspace is kept there are none.
  // `level`: its number. `tiling` must outlive it. `earlier`: what those of the run before an update were
  // made from; empty: there are none. `check`: the table suffices where no output is read.
  KeptOutputs(std::size_t level, const Tiling& tiling, const std::string& made_from,
              const std::string& earlier, PartReader::Check check, const Job& job);

  std::vector<TileIndex> missing() const;  // tiles of which nothing is kept, ascending
  // visit(tile, output), from several threads at once.
  void for_each(const Job& job, const std::function<void(TileIndex, const TileOutput&)>& visit) const;

  // The output of the run before that has this content, if there is one. From any thread.
  std::optional<TileOutput> find_earlier(TileIndex tile, const Digest& content) const;

  // From any thread.
  void add(TileIndex tile, const TileOutput& output);
  // Seals the last outputs.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void seal();

  std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) const;
  void find_earlier_parts(const std::filesystem::path& folder, const Digest& made_from);

  std::size_t level_;
  const Tiling& tiling_;
  std::filesystem::path prefix_;  // of the parts; empty: none is kept
  Digest made_from_;
  std::vector<PartReader> parts_, earlier_;
  std::vector<std::uint8_t> has_;        // by tile
  std::vector<std::size_t> earlier_of_;  // by tile: one more than the number of the part; 0: none
  std::mutex mutex_;
  std::optional<PartWriter> writer_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point begun_;          // when the open part was
  const Clock::duration least_age_;  // of a part, unless it is large
};

}  // namespace lacuna
