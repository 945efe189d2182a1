// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/tile_output.hpp"

namespace lacuna {
namespace {

constexpr int kShift = 32;  // of the tile's number

}  // namespace

Row to_stored_row(Row row, const Tiling& tiling) {
  const TileIndex tile = tiling.tile_of_row(row);
  return Row{std::uint64_t{tile} << kShift | tiling.tiles[tile].local(row)};
}

Row from_stored_row(Row stored, const Tiling& tiling) {
  const std::uint64_t tile = value(stored) >> kShift;
  const auto local = static_cast<LocalIndex>(value(stored));
  if (tile >= tiling.tiles.size() || local >= tiling.tiles[tile].points)
    fail_inconsistent("an output of a tile has a row that no tile has");
  return tiling.tiles[tile].row(local);
}

}  // namespace lacuna
