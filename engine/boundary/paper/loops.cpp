// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/loops.hpp"

#include "engine/run/error.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>

namespace lacuna::paper {
namespace {

// A search starts here; in ascending id.
struct Origin {
  PointId id;
  LocalIndex vertex;

  friend bool operator<(const Origin& a, const Origin& b) { return a.id < b.id; }
};

class Search {
 public:
  Search(const SpanningGraph& graph, Scratch& scratch)
      : graph_(graph),
        scratch_(scratch),
        reached_(scratch.array<Reached>(graph.size())),
        queue_(scratch.array<LocalIndex>(graph.size())) {}

  bool is_on_loop(LocalIndex v) const { return reached_[v].is_on_loop != 0; }

  // Returns the loop through the origin, and an empty loop where there is none.
  std::span<const LocalIndex> loop_through(LocalIndex origin) {
    ++stamp_;
    loop_.clear();
    reached_[origin].stamp = stamp_;
    std::size_t tail = 0;
    queue_[tail++] = origin;
    for (std::size_t head = 0; head < tail; ++head) {
      scratch_.trim();
      const LocalIndex v = queue_[head];
      for (const LocalIndex w : graph_[v]) {
        Reached& there = reached_[w];
        if (there.stamp != stamp_) {
          there = {stamp_, v, v == origin ? w : reached_[v].branch, there.is_on_loop};
          queue_[tail++] = w;
        } else if (v != origin && w != origin && reached_[v].branch != there.branch) {
          trace(origin, v, w);
          for (const LocalIndex on_loop : loop_) reached_[on_loop].is_on_loop = 1;
          return loop_;
        }
      }
    }
    return loop_;
  }

 private:
  struct Reached {
    LocalIndex stamp;  // of the search
    LocalIndex parent, branch;
    LocalIndex is_on_loop;
  };

  // The loop goes from the origin down to v, then from w back up. It is turned to the canonical start and
  // direction.
  void trace(LocalIndex origin, LocalIndex v, LocalIndex w) {
    for (LocalIndex at = v; at != origin; at = reached_[at].parent) loop_.push_back(at);
    loop_.push_back(origin);
    std::reverse(loop_.begin(), loop_.end());
    for (LocalIndex at = w; at != origin; at = reached_[at].parent) loop_.push_back(at);
    const auto lower_id = [&](LocalIndex a, LocalIndex b) { return graph_.ids[a] < graph_.ids[b]; };
    std::rotate(loop_.begin(), std::min_element(loop_.begin(), loop_.end(), lower_id), loop_.end());
    if (lower_id(loop_.back(), loop_[1])) std::reverse(loop_.begin() + 1, loop_.end());
  }

  const SpanningGraph& graph_;
  Scratch& scratch_;
  std::span<Reached> reached_;
  std::span<LocalIndex> queue_;  // as long as the component, at worst
  LocalIndex stamp_ = 0;
  std::vector<LocalIndex> loop_;
};

}  // namespace

void find_loops(const SpanningGraph& graph, Scratch& scratch,
                const std::function<void(std::span<const LocalIndex>)>& report) {
  if (graph.indices.empty()) return;
  SortedRuns<Origin> origins(scratch.folder() / "origins", scratch.budget() / 8);
  for (LocalIndex v = 0; v < graph.size(); ++v) {
    scratch.trim();
    if (!graph[v].empty()) origins.add({graph.ids[v], v});
  }
  Search search(graph, scratch);
  origins.for_each([&](const Origin& origin) {
    if (search.is_on_loop(origin.vertex)) return;
    const std::span<const LocalIndex> loop = search.loop_through(origin.vertex);
    if (!loop.empty()) report(loop);
  });
}

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
