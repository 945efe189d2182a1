// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/star_exchange.hpp"

#include <algorithm>
#include <span>
#include <tuple>

namespace lacuna::tangential {

bool operator<(const RemoteTriangle& a, const RemoteTriangle& b) {
  return std::tie(a.to, a.from, a.other) < std::tie(b.to, b.from, b.other);
}

StarExchange::StarExchange(const TileOutputs& outputs, const Tiling& tiling, const Spill& spill,
                           const TaskArena& arena)
    : outputs(outputs),
      tiling(tiling),
      active(tiling.row_count()),
      around(tiling.tiles.size()),
      sites(spill.file("sites")),
      samples(spill.file("samples")),
      remote_triangles(spill, "remote-triangles", tiling.tiles.size()),
      numbers_(tiling.tiles.size()),
      belt_stars_(spill, "belt-stars", tiling.tiles.size()),
      belt_vertices_(spill, "belt-vertices", tiling.tiles.size()) {
  // The sampled points of one tile after the other have places in the columns of sites and samples.
  std::uint64_t place = 0;
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    first_places_.push_back(place);
    place += outputs.count(kSampled, t);
  }
  // Tiles begin with the points that they know to be active, and with the tiles that their belts touch.
  arena.for_each(tiling.tiles.size(), [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    for (const LocalIndex p : outputs.read(kActive, t)) active.insert(tiling.tiles[t].row(p));
    around[t] = tiling.tiles_of(outputs.read(kBeltRows, t));
  });
}

void StarExchange::publish(TileIndex tile) {
  const std::vector<LocalIndex> sampled = outputs.read(kSampled, tile);
  numbers_[tile].collect(sampled.size(), [&](auto&& add) {
    for (const LocalIndex p : sampled) add(tiling.tiles[tile].row(p));
  });
  sites.write(first_places_[tile], outputs.read(kSites, tile));
  samples.write(first_places_[tile], outputs.read(kSamples, tile));
}

std::vector<Row> StarExchange::places_of(std::span<const Row> rows) const {
  std::vector<Row> places;
  places.reserve(rows.size());
  TileIndex tile = 0;
  for (const Row row : rows) {
    if (!tiling.tiles[tile].owns(row)) tile = tiling.tile_of_row(row);
    places.push_back(Row{first_places_[tile] + numbers_[tile].number(row)});
  }
  return places;
}

void StarExchange::add_belt_stars(TileIndex tile, const OpenStars& stars) {
  belt_stars_.append(tile, stars.stars);
  belt_vertices_.append(tile, stars.vertices);
}

OpenStars StarExchange::open_stars(TileIndex tile) const {
  OpenStars open{outputs.read(kOpenStars, tile), outputs.read(kOpenVertices, tile)};
  // The links of the belt's stars come last.
  const auto before = static_cast<std::uint32_t>(open.vertices.size());
  const auto of_tile = static_cast<std::ptrdiff_t>(open.stars.size());
  for (OpenStar star : belt_stars_.read(tile)) {
    star.place.begin += before;
    open.stars.push_back(star);
  }
  const std::vector<OpenLinkVertex> vertices = belt_vertices_.read(tile);
  open.vertices.insert(open.vertices.end(), vertices.begin(), vertices.end());
  std::ranges::inplace_merge(open.stars, open.stars.begin() + of_tile, {}, &OpenStar::owned);
  return open;
}

std::uint64_t StarExchange::open_star_count(TileIndex tile) const {
  return outputs.count(kOpenStars, tile) + belt_stars_.count(tile);
}

std::uint64_t StarExchange::open_vertex_count(TileIndex tile) const {
  return outputs.count(kOpenVertices, tile) + belt_vertices_.count(tile);
}

}  // namespace lacuna::tangential
