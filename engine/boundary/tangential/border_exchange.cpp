// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/border_exchange.hpp"

#include "engine/boundary/tangential/belt.hpp"
#include "engine/boundary/tangential/growth.hpp"
#include "engine/run/rounds.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <vector>

namespace lacuna::tangential {
namespace {

// A tile whose active points grow, or whose wedges are known then.
struct GrowingTile {
  GrowingTile(StarLists& lists, const Tiling& tiling, TileIndex t, std::span<const std::uint8_t> is_measured)
      : open(lists.read_open(t)),
        triangles(lists.remote_triangles.read(t)),
        growth(tiling, t, is_measured, lists.active, open, sorted(triangles)) {}

  static std::span<const RemoteTriangle> sorted(std::vector<RemoteTriangle>& triangles) {
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  }

  OpenStars open;
  std::vector<RemoteTriangle> triangles;
  Growth growth;
};

std::uint64_t growing_bytes(const StarLists& lists, const Tile& tile, TileIndex t) {
  return lists.open_stars.count(t) * 2 * sizeof(OpenStar) +
         lists.open_vertices.count(t) * 2 * sizeof(OpenLinkVertex) +
         lists.remote_triangles.count(t) * sizeof(RemoteTriangle) + tile.points * sizeof(LocalIndex);
}

class BorderExchange {
 public:
  BorderExchange(StarLists& lists, const Tiling& tiling, Job& job)
      : lists_(lists),
        tiling_(tiling),
        job_(job),
        is_sampled_(tiling.tiles.size()),
        is_measured_(tiling.tiles.size()) {}

  void run() {
    Rounds rounds(tiling_.tiles.size());
    const std::vector<TileIndex> all(rounds.tiles().begin(), rounds.tiles().end());
    for (; !rounds.tiles().empty(); rounds.next()) {
      const std::vector<TileIndex> tiles = with_neighbours(rounds.tiles());
      measure(tiles);
      for_each_growing(tiles, [&](TileIndex t) {
        if (is_measured_[t]) grow(t, rounds);
      });
    }
    for_each_growing(all, [&](TileIndex t) {
      lists_.wedges.append(
          t, GrowingTile(lists_, tiling_, t, is_measured_).growth.wedges(job_.config.tangential));
      lists_.drop(t);
    });
  }

 private:
  // These tiles and all that they border on.
  std::vector<TileIndex> with_neighbours(std::span<const TileIndex> tiles) const {
    std::set<TileIndex> all;
    for (const TileIndex t : tiles) all.insert(lists_.around[t].begin(), lists_.around[t].end());
    return {all.begin(), all.end()};
  }

  // The belts of tiles with an active belt point. Others stay as they are: on clean scans, most do.
  void measure(std::span<const TileIndex> tiles) {
    std::vector<std::uint8_t> has_active(tiles.size());
    job_.arena.for_each(tiles.size(), [&](std::size_t i) {
      has_active[i] = !is_measured_[tiles[i]] && has_active_belt(tiles[i]);
    });
    std::vector<TileIndex> to_measure, to_sample;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      if (has_active[i]) to_measure.push_back(tiles[i]);
    }
    for (const TileIndex t : with_neighbours(to_measure)) {
      if (!is_sampled_[t]) to_sample.push_back(t);
    }
    const TangentialConfig& config = job_.config.tangential;
    const auto bytes = [&](TileIndex t) { return belt_bytes(lists_, t); };
    for_each(to_sample, bytes, [&](TileIndex t) { sample_border(lists_, t, config); });
    for_each(to_measure, bytes, [&](TileIndex t) { measure_belt(lists_, tiling_, t, config); });
    for (const TileIndex t : to_sample) is_sampled_[t] = 1;
    for (const TileIndex t : to_measure) is_measured_[t] = 1;
  }

  bool has_active_belt(TileIndex t) const {
    const std::vector<Row> rows = lists_.belt_rows.read(t);
    return std::any_of(rows.begin(), rows.end(),
                       [&](Row row) { return tiling_.tiles[t].owns(row) && lists_.active.contains(row); });
  }

  // Requests the tiles of points that become active, where another tile has to know of it.
  void grow(TileIndex t, Rounds& rounds) {
    const Tile& tile = tiling_.tiles[t];
    GrowingTile growing(lists_, tiling_, t, is_measured_);
    growing.growth.find_active_points([&](Row row) {
      if (tile.owns(row) && !has_remote_triangle(growing.triangles, tile.local(row))) return;
      const TileIndex owner = tiling_.tile_of_row(row);
      rounds.request({&owner, 1});
    });
  }

  template <class Step>
  void for_each_growing(std::span<const TileIndex> tiles, Step&& step) {
    for_each(
        tiles, [&](TileIndex t) { return growing_bytes(lists_, tiling_.tiles[t], t); }, step);
  }

  template <class Bytes, class Step>
  void for_each(std::span<const TileIndex> tiles, Bytes&& bytes, Step&& step) {
    std::vector<std::uint64_t> needs;
    needs.reserve(tiles.size());
    for (const TileIndex t : tiles) needs.push_back(bytes(t));
    job_.arena.for_each_within_budget(needs, job_.memory.global, [&](std::size_t i) { step(tiles[i]); });
  }

  StarLists& lists_;
  const Tiling& tiling_;
  Job& job_;
  std::vector<std::uint8_t> is_sampled_, is_measured_;  // by tile
};

}  // namespace

void exchange_borders(StarLists& lists, const Tiling& tiling, Job& job) {
  BorderExchange(lists, tiling, job).run();
}

}  // namespace lacuna::tangential
