// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/placed_loops.hpp"

#include "engine/run/error.hpp"
#include "engine/store/outbox.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace lacuna {
namespace {

// A place among the points of all loops, and the point that belongs there.
struct Wanted {
  Row row;
  std::uint64_t place;
};

using WantedLists = AppendLists<Wanted>;

WantedLists wanted_points(const RawLoops& loops, const Tiling& tiling, const Job& job) {
  WantedLists wanted(job.file("wanted-loop-points"), tiling.tiles.size(), job.memory.spills / 4);
  Outbox<Wanted> outbox(wanted);
  std::uint64_t place = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    loops.for_each_vertex(i, [&](const Vertex& v) {
      outbox.add(tiling.tile_of_row(v.row), {v.row, place++});
    });
  }
  outbox.send();
  return wanted;
}

// Puts the points of a tile into their places.
void place_points(std::vector<Wanted> wanted, std::span<const StoredVertex> vertices, const Tile& tile,
                  Column<StoredLoopPoint>& points) {
  std::sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) { return a.place < b.place; });
  std::vector<StoredLoopPoint> run;  // of consecutive places
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const LocalIndex owned = tile.local(wanted[i].row);
    const auto vertex = std::lower_bound(vertices.begin(), vertices.end(), owned,
                                         [](const StoredVertex& v, LocalIndex p) { return v.owned < p; });
    if (vertex == vertices.end() || vertex->owned != owned)
      fail_inconsistent("a loop passes through a point that was not kept");
    run.push_back(
        {vertex->point, {vertex->surface[0], vertex->surface[1], vertex->surface[2]}, vertex->probability});
    if (i + 1 < wanted.size() && wanted[i + 1].place == wanted[i].place + 1) continue;
    points.write(wanted[i].place + 1 - run.size(), run);
    run.clear();
  }
}

}  // namespace

void PlacedLoops::for_each_point(std::size_t loop,
                                 const std::function<void(const StoredLoopPoint&)>& visit) const {
  ColumnReader<StoredLoopPoint> reader(points);
  for (std::uint64_t i = offsets[loop]; i < offsets[loop + 1]; ++i) visit(reader[i]);
}

PlacedLoops place_loops(const RawLoops& loops, const LoopPointLists& lists, const Tiling& tiling, Job& job) {
  PlacedLoops placed{.points = Column<StoredLoopPoint>(job.file("placed-loops"))};
  const WantedLists wanted = wanted_points(loops, tiling, job);
  job.arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
    if (wanted.count(t) > 0) place_points(wanted.read(t), lists.read(t), tiling.tiles[t], placed.points);
  });
  for (std::size_t i = 0; i < loops.size(); ++i)
    placed.offsets.push_back(placed.offsets.back() + loops.points(i));
  return placed;
}

void for_each_loop(
    const PlacedLoops& loops, Job& job,
    const std::function<void(std::size_t, std::span<const StoredLoopPoint>, Scratch&)>& visit) {
  std::vector<std::uint64_t> needs;
  const std::uint64_t most = job.memory.global / (2 * job.arena.threads());
  for (std::size_t i = 0; i < loops.size(); ++i)
    needs.push_back(std::min(most, 2 * loops.count(i) * sizeof(StoredLoopPoint)));
  job.arena.for_each_within_budget(needs, job.memory.global, [&](std::size_t i) {
    Scratch scratch(job.workspace, most);
    const std::span<StoredLoopPoint> loop = scratch.array<StoredLoopPoint>(loops.count(i));
    loops.points.read(loops.offsets[i], loop);
    visit(i, loop, scratch);
  });
}

}  // namespace lacuna
