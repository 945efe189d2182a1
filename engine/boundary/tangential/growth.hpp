// SPDX-License-Identifier: Apache-2.0
// growth: grows active points among a tile's open stars, and finds their wedges, with what other tiles sent.
#pragma once

#include "engine/boundary/tangential/star_exchange.hpp"
#include "engine/boundary/tangential/wedge.hpp"
#include "engine/model/tiling.hpp"
#include "engine/store/row_set.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna::tangential {

// Returns whether any star in another tile has a triangle with this point. `remote_triangles`: sorted.
bool has_remote_triangle(std::span<const RemoteTriangle> remote_triangles, LocalIndex point);

// Grows the active points of a tile along inconsistent triangles (method.md, C.4). All points that may become
// active have an open star; `remote_triangles` are sorted. A foreign star that is not measured yet makes no
// triangle inconsistent. `is_measured`, by tile, marks the tiles whose stars sent their triangles.
class Growth {
 public:
  Growth(const Tiling& tiling, TileIndex tile, std::span<const std::uint8_t> is_measured, RowSet& active,
         const OpenStars& open, std::span<const RemoteTriangle> remote_triangles);

  // Makes vertices of inconsistent triangles of active points active, here and in other tiles, until there
  // are no more. It calls visit(row) for each point that was not active before. Several tiles may grow at
  // once.
  void find_active_points(const std::function<void(Row)>& visit);

  // Returns each wedge of active points, in ascending row. All active points must be known.
  std::vector<Wedge> wedges();
  CurvePoint curve_point(const Wedge& wedge, const TangentialConfig& config) const;

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Row row(std::size_t s) const { return tile_.row(points_[s].owned); }
  bool follow(std::size_t s, const std::function<void(Row)>& visit);
  bool is_inconsistent(std::size_t s, std::size_t i);
  Scale scale_of(std::size_t s, std::size_t i);
  Scale scale_in(Row point, std::size_t s, Row third) const;

  const Tiling& tiling_;
  const Tile& tile_;
  std::span<const std::uint8_t> is_measured_;
  RowSet& active_;
  std::span<const RemoteTriangle> remote_triangles_;
  std::span<const OpenStar> points_;
  std::span<const OpenLinkVertex> vertices_;
  Stars<Row> stars_;
  std::vector<std::uint32_t> star_of_;  // by owned index
};

}  // namespace lacuna::tangential
