// SPDX-License-Identifier: Apache-2.0
// Exchanges the stars of the belts between tiles.
#pragma once

#include "engine/boundary/tangential/star_exchange.hpp"
#include "engine/boundary/tangential/wedge.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {
class Rounds;
}

namespace lacuna::tangential {

// Wedges of open stars, in ascending row, and the curve point of each.
struct OpenWedges {
  std::vector<Wedge> wedges;
  std::vector<CurvePoint> points;
};

// Finds the active points and the wedges that depend on several tiles.
//
// Active points are a least fixed point (method.md, C.4). So tiles may grow them in any order, and again
// while a neighbouring tile has new ones. A tile takes part once a point of its belt is active. Its belt is
// measured after the borders of the tiles around it are sampled. Cost: the stars of the measured belts, and
// the open stars once in each round.
class BorderExchange {
 public:
  BorderExchange(const TileOutputs& outputs, const Tiling& tiling, const TangentialConfig& config,
                 const Spill& spill, const Workers& workers);

  // Finds all active points.
  void find_active_points();

  // Returns the wedges of a tile's open stars, once all active points are found. From any thread.
  OpenWedges wedges(TileIndex tile);
  std::uint64_t most_wedges(TileIndex tile) const;
  std::uint64_t growing_bytes(TileIndex tile) const;  // memory that finding them takes

 private:
  std::vector<TileIndex> with_neighbours(std::span<const TileIndex> tiles) const;
  void measure(std::span<const TileIndex> tiles);
  bool has_active_belt(TileIndex tile) const;
  void grow(TileIndex tile, Rounds& rounds);
  template <class Bytes, class Step>
  void for_each(std::span<const TileIndex> tiles, Bytes&& bytes, Step&& step);

  const TangentialConfig& config_;
  const Workers& workers_;
  StarExchange stars_;
  std::vector<std::uint8_t> is_published_, is_sampled_, is_measured_;  // by tile
};

}  // namespace lacuna::tangential
