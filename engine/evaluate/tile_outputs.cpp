// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/tile_outputs.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace lacuna {
TileOutputs::TileOutputs(const Tiling& tiling, std::optional<KeptOutputs> kept, const Job& job)
    : tiling_(&tiling),
      kept_(std::move(kept)),
      lists_(std::make_unique<AppendBytes>(job.file("outputs"), 0, job.lists)) {}

std::vector<TileIndex> TileOutputs::missing() const {
  if (kept_) return kept_->missing();
  std::vector<TileIndex> all(tiling_->tiles.size());
  std::iota(all.begin(), all.end(), TileIndex{0});
  return all;
}

void TileOutputs::add(TileIndex tile, const TileOutput& output) {
  if (!kept_) {
    for (const TileOutput::Stream& stream : output.streams_)
      lists_->append(make_list(stream.name, tile), stream.bytes);
    return;
  }
  std::vector<KeptOutputs::Stream> streams;
  for (const TileOutput::Stream& stream : output.streams_) streams.push_back({stream.name, stream.bytes});
  kept_->add(tile, streams);
}

void TileOutputs::finish() {
  if (kept_) kept_->finish();
}

std::size_t TileOutputs::list_of(std::string_view stream, TileIndex tile) const {
  const auto at = std::find(streams_.begin(), streams_.end(), stream);
  if (at == streams_.end()) return kUnknown;
  return static_cast<std::size_t>(at - streams_.begin()) * tiling_->tiles.size() + tile;
}

std::size_t TileOutputs::make_list(std::string_view stream, TileIndex tile) {
  const std::lock_guard lock(*mutex_);
  if (const std::size_t list = list_of(stream, tile); list != kUnknown) return list;
  streams_.push_back(stream);
  lists_->add_lists(tiling_->tiles.size());
  return list_of(stream, tile);
}

std::uint64_t TileOutputs::record_count(std::string_view stream, TileIndex tile,
                                        std::size_t record_bytes) const {
  const std::size_t list = list_of(stream, tile);
  const std::uint64_t bytes = kept_ ? kept_->size(stream, tile) : list == kUnknown ? 0 : lists_->size(list);
  if (bytes % record_bytes != 0)
    fail_inconsistent("the stream " + std::string(stream) + " of a tile is not of whole records");
  return bytes / record_bytes;
}

void TileOutputs::read_bytes(std::string_view stream, TileIndex tile, std::span<std::byte> to) const {
  if (to.empty()) return;
  if (kept_) {
    kept_->read(stream, tile, to);
  } else {
    lists_->read(list_of(stream, tile), to.data());
  }
}

}  // namespace lacuna
