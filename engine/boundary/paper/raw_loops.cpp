// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/raw_loops.hpp"

#include "engine/run/error.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/outbox.hpp"

#include <algorithm>

namespace lacuna::paper {
namespace {

// A place among the vertices of all loops, and the row of the point that belongs there.
struct WantedPoint {
  Row row;
  std::uint64_t place;
};
using WantedPoints = AppendLists<WantedPoint>;

WantedPoints wanted_points(const Column<Vertex>& vertices, const Tiling& tiling, const Spill& spill) {
  WantedPoints wanted(spill, "wanted-points", tiling.tiles.size());
  Outbox<WantedPoint> outbox(wanted);
  ColumnReader<Vertex> reader(vertices);
  for (std::uint64_t place = 0; place < vertices.size(); ++place) {
    const Row row = reader[place].row;
    outbox.add(tiling.tile_of_row(row), {row, place});
  }
  outbox.send();
  return wanted;
}

// Writes the points of a tile to their places.
void place_points(std::vector<WantedPoint> wanted, std::span<const TileVertex> vertices, const Tile& tile,
                  Column<LoopPoint>& points) {
  std::sort(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) { return a.place < b.place; });
  std::vector<LoopPoint> run;  // of consecutive places
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const LocalIndex owned = tile.local(wanted[i].row);
    const auto vertex = std::lower_bound(vertices.begin(), vertices.end(), owned,
                                         [](const TileVertex& v, LocalIndex p) { return v.owned < p; });
    if (vertex == vertices.end() || vertex->owned != owned)
      fail_inconsistent("a loop passes through a point that was not kept");
    run.push_back(*vertex);
    if (i + 1 < wanted.size() && wanted[i + 1].place == wanted[i].place + 1) continue;
    points.write(wanted[i].place + 1 - run.size(), run);
    run.clear();
  }
}

}  // namespace

void RawLoops::add(std::span<const Vertex> loop) {
  const std::lock_guard lock(*mutex_);
  vertices_.append(loop);
  counts_.push_back(loop.size());
}

Loops RawLoops::with_points(const TileOutputs& outputs, const Tiling& tiling, const Spill& spill,
                            const TaskArena& arena) const {
  Column<LoopPoint> points(spill.file("placed-points"));
  const WantedPoints wanted = wanted_points(vertices_, tiling, spill);
  arena.for_each(tiling.tiles.size(), [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    if (wanted.count(t) > 0)
      place_points(wanted.read(t), outputs.read(kVertices, t), tiling.tiles[t], points);
  });
  Loops loops(spill.file("loops"));
  ColumnReader<LoopPoint> reader(points);
  std::uint64_t first = 0;
  for (const std::uint64_t count : counts_) {
    loops.add(count, {}, [&](std::uint64_t i) { return reader[first + i]; });
    first += count;
  }
  loops.sort();
  return loops;
}

}  // namespace lacuna::paper
