// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/tile_outputs.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace lacuna {
namespace {

constexpr int kTileShift = 32;  // bits of a sealed row that are the place in the tile

}  // namespace

Row to_stored_row(Row row, const Tiling& tiling) {
  const TileIndex tile = tiling.tile_of_row(row);
  return Row{std::uint64_t{tile} << kTileShift | tiling.tiles[tile].local(row)};
}

Row from_stored_row(Row stored, const Tiling& tiling) {
  const std::uint64_t tile = value(stored) >> kTileShift;
  const auto local = static_cast<LocalIndex>(value(stored));
  if (tile >= tiling.tiles.size() || local >= tiling.tiles[tile].points)
    fail_inconsistent("an output of a tile has a row that no tile has");
  return tiling.tiles[tile].row(local);
}

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

void TileOutputs::add(TileIndex tile, TileOutput output, const Digest& content) {
  if (!kept_) {
    for (const TileOutput::Stream& stream : output.streams_)
      lists_->append(make_list(stream.name, tile), stream.bytes);
    return;
  }
  std::vector<KeptOutputs::Stream> stored;
  for (TileOutput::Stream& stream : output.streams_) {
    if (stream.store_rows != nullptr) stream.store_rows(stream.bytes, *tiling_);
    stored.push_back({stream.name, stream.bytes});
  }
  kept_->add(tile, content, stored);
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
