// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/star_lists.hpp"

#include "engine/store/merge_runs.hpp"

#include <tuple>

namespace lacuna::tangential {

bool operator<(const RemoteTriangle& a, const RemoteTriangle& b) {
  return std::tie(a.to, a.from, a.other) < std::tie(b.to, b.from, b.other);
}

StarLists::StarLists(const TileStore& store, const Job& job)
    : belt(job.file("belt"), store.tiling().tiles.size(), job.memory.spills / 16),
      belt_rows(job.file("belt-rows"), store.tiling().tiles.size(), job.memory.spills / 16),
      belt_neighbours(job.file("belt-neighbours"), store.tiling().tiles.size(), job.memory.spills / 16),
      around(store.tiling().tiles.size()),
      sites(job.file("sites")),
      samples(job.file("samples")),
      active(store.tiling().row_count()),
      open_stars(job.file("open-stars"), store.tiling().tiles.size(), job.memory.spills / 16),
      open_vertices(job.file("open-vertices"), store.tiling().tiles.size(), job.memory.spills / 8),
      remote_triangles(job.file("remote-triangles"), store.tiling().tiles.size(), job.memory.spills / 8),
      wedges(job.file("wedges"), store.tiling().tiles.size(), job.memory.spills / 8) {}

void StarLists::append_open(TileIndex tile, OpenStars stars) {
  const auto before = static_cast<std::uint32_t>(open_vertices.count(tile));
  for (OpenStar& star : stars.stars) star.place.begin += before;
  open_stars.append(tile, stars.stars);
  open_vertices.append(tile, stars.vertices);
}

OpenStars StarLists::read_open(TileIndex tile) const {
  OpenStars stars{open_stars.read(tile), open_vertices.read(tile)};
  merge_runs(stars.stars, [](const OpenStar& a, const OpenStar& b) { return a.owned < b.owned; });
  return stars;
}

void StarLists::drop(TileIndex tile) {
  belt.drop(tile);
  belt_rows.drop(tile);
  belt_neighbours.drop(tile);
  open_stars.drop(tile);
  open_vertices.drop(tile);
  remote_triangles.drop(tile);
}

}  // namespace lacuna::tangential
