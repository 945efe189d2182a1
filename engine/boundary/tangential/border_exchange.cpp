// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/border_exchange.hpp"

#include "engine/boundary/rounds.hpp"
#include "engine/boundary/tangential/belt.hpp"
#include "engine/boundary/tangential/growth.hpp"

#include <algorithm>
#include <set>

namespace lacuna::tangential {
namespace {

// A tile whose active points grow, or whose wedges are then known.
struct GrowingTile {
  GrowingTile(StarExchange& stars, TileIndex t, std::span<const std::uint8_t> is_measured)
      : open(stars.open_stars(t)),
        triangles(stars.remote_triangles.read(t)),
        growth(stars.tiling, t, is_measured, stars.active, open, sorted(triangles)) {}

  static std::span<const RemoteTriangle> sorted(std::vector<RemoteTriangle>& triangles) {
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  }

  OpenStars open;
  std::vector<RemoteTriangle> triangles;
  Growth growth;
};

// Returns the tiles among `tiles` that are not marked.
std::vector<TileIndex> without_marked(std::span<const TileIndex> tiles, std::span<const std::uint8_t> marks) {
  std::vector<TileIndex> unmarked;
  for (const TileIndex t : tiles) {
    if (marks[t] == 0) unmarked.push_back(t);
  }
  return unmarked;
}

}  // namespace

BorderExchange::BorderExchange(const TileOutputs& outputs, const Tiling& tiling,
                               const TangentialConfig& config, const Spill& spill, const Workers& workers)
    : config_(config),
      workers_(workers),
      stars_(outputs, tiling, spill, workers.arena),
      is_published_(tiling.tiles.size()),
      is_sampled_(tiling.tiles.size()),
      is_measured_(tiling.tiles.size()) {}

void BorderExchange::find_active_points() {
  for (Rounds rounds(stars_.tiling.tiles.size()); !rounds.tiles().empty(); rounds.next()) {
    const std::vector<TileIndex> tiles = with_neighbours(rounds.tiles());
    measure(tiles);
    for_each(
        tiles, [&](TileIndex t) { return growing_bytes(t); },
        [&](TileIndex t) {
          if (is_measured_[t] != 0) grow(t, rounds);
        });
  }
}

OpenWedges BorderExchange::wedges(TileIndex tile) {
  GrowingTile growing(stars_, tile, is_measured_);
  OpenWedges open{growing.growth.wedges(), {}};
  open.points.reserve(open.wedges.size());
  for (const Wedge& wedge : open.wedges) open.points.push_back(growing.growth.curve_point(wedge, config_));
  return open;
}

// A star has no more wedges at a scale than half of its link vertices.
std::uint64_t BorderExchange::most_wedges(TileIndex tile) const {
  return stars_.open_vertex_count(tile);
}

std::uint64_t BorderExchange::growing_bytes(TileIndex tile) const {
  return stars_.open_star_count(tile) * 2 * sizeof(OpenStar) +
         stars_.open_vertex_count(tile) * 2 * sizeof(OpenLinkVertex) +
         stars_.remote_triangles.count(tile) * sizeof(RemoteTriangle) +
         stars_.tiling.tiles[tile].points * sizeof(LocalIndex);
}

// Returns these tiles and all tiles that they border on.
std::vector<TileIndex> BorderExchange::with_neighbours(std::span<const TileIndex> tiles) const {
  std::set<TileIndex> all;
  for (const TileIndex t : tiles) all.insert(stars_.around[t].begin(), stars_.around[t].end());
  return {all.begin(), all.end()};
}

// Measures the belts of tiles with an active belt point. On clean scans, most tiles have none.
void BorderExchange::measure(std::span<const TileIndex> tiles) {
  std::vector<std::uint8_t> is_inactive(is_measured_);
  workers_.arena.for_each(tiles.size(), [&](std::size_t i) {
    if (!has_active_belt(tiles[i])) is_inactive[tiles[i]] = 1;
  });
  const std::vector<TileIndex> to_measure = without_marked(tiles, is_inactive);
  const std::vector<TileIndex> to_sample = without_marked(with_neighbours(to_measure), is_sampled_);
  const std::vector<TileIndex> to_publish = without_marked(with_neighbours(to_sample), is_published_);
  const auto bytes = [&](TileIndex t) { return belt_bytes(stars_, t); };
  for_each(to_publish, bytes, [&](TileIndex t) { stars_.publish(t); });
  for_each(to_sample, bytes, [&](TileIndex t) { sample_border(stars_, t, config_); });
  for_each(to_measure, bytes, [&](TileIndex t) { measure_belt(stars_, t, config_); });
  for (const TileIndex t : to_publish) is_published_[t] = 1;
  for (const TileIndex t : to_sample) is_sampled_[t] = 1;
  for (const TileIndex t : to_measure) is_measured_[t] = 1;
}

bool BorderExchange::has_active_belt(TileIndex t) const {
  const std::vector<Row> rows = stars_.outputs.read(kBeltRows, t);
  return std::any_of(rows.begin(), rows.end(), [&](Row row) {
    return stars_.tiling.tiles[t].owns(row) && stars_.active.contains(row);
  });
}

// Requests the tiles of points that become active, where another tile has to know of the point.
void BorderExchange::grow(TileIndex t, Rounds& rounds) {
  const Tile& tile = stars_.tiling.tiles[t];
  GrowingTile growing(stars_, t, is_measured_);
  growing.growth.find_active_points([&](Row row) {
    if (tile.owns(row) && !has_remote_triangle(growing.triangles, tile.local(row))) return;
    const TileIndex owner = stars_.tiling.tile_of_row(row);
    rounds.request({&owner, 1});
  });
}

template <class Bytes, class Step>
void BorderExchange::for_each(std::span<const TileIndex> tiles, Bytes&& bytes, Step&& step) {
  std::vector<std::uint64_t> needs;
  needs.reserve(tiles.size());
  for (const TileIndex t : tiles) needs.push_back(bytes(t));
  workers_.for_each_within(workers_.memory.work, needs, [&](std::size_t i) { step(tiles[i]); });
}

}  // namespace lacuna::tangential
