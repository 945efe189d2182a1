// SPDX-License-Identifier: Apache-2.0
#include "engine/results/loop_rows.hpp"

#include "engine/model/distance_bound.hpp"
#include "engine/run/error.hpp"
#include "engine/store/append_lists.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <vector>

namespace lacuna {
namespace {

// Calls visit(tile) for each tile that may have a point at this place.
template <class Visit>
void for_each_tile_at(const Tiling& tiling, const Eigen::Vector3d& place, Visit&& visit) {
  std::optional<TileIndex> last;
  for_each_cell_near(tiling, Eigen::AlignedBox3d(place), 0, 0, 0, [&](std::uint32_t cell) {
    const TileIndex tile = tiling.tile_of_cell(cell);
    if (last != tile) visit(tile);
    last = tile;
    return true;
  });
}

// Sends every point on a loop to the tiles that may have it.
void send_points(const ChosenLoops& loops, std::span<const std::size_t> selected, const Tiling& tiling,
                 AppendLists<MarkedPoint>& sent) {
  Outbox<MarkedPoint> outbox(sent);
  std::size_t next_selected = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const bool is_reported = next_selected < selected.size() && selected[next_selected] == i;
    const std::int32_t name = is_reported ? static_cast<std::int32_t>(next_selected++) : kNotReported;
    loops.for_each_point(i, [&](const LoopPoint& p) {
      for_each_tile_at(tiling, p.position(), [&](TileIndex t) {
        outbox.add(t, {p, kNoIndex, name, p.probability, MarkedPoint::kBoundary});
      });
    });
  }
  outbox.send();
}

// Returns the points that the tile has, with their places in it.
std::vector<MarkedPoint> owned_points(std::vector<MarkedPoint> points, const TileStore& store, TileIndex t) {
  const auto by_id = [](const ScanPoint& a, const ScanPoint& b) { return a.id < b.id; };
  std::sort(points.begin(), points.end(), by_id);
  LocalIndex owned = 0;
  store.for_each_point(t, [&](const ScanPoint& p) {
    const auto [begin, end] = std::equal_range(points.begin(), points.end(), p, by_id);
    std::for_each(begin, end, [&](MarkedPoint& on_loop) { on_loop.owned = owned; });
    ++owned;
  });
  std::erase_if(points, [](const MarkedPoint& p) { return p.owned == kNoIndex; });
  return points;
}

}  // namespace

LoopRows find_loop_rows(const ChosenLoops& loops, std::span<const std::size_t> selected,
                        const TileStore& store, const Spill& spill, const TaskArena& arena) {
  const Tiling& tiling = store.tiling();
  LoopRows found{AppendLists<MarkedPoint>(spill, "points-of-loops", tiling.tiles.size()),
                 RowSet(tiling.row_count())};
  send_points(loops, selected, tiling, found.points);
  std::atomic<std::uint64_t> count = 0;
  arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
    if (found.points.count(t) == 0) return;
    const std::vector<MarkedPoint> points =
        owned_points(found.points.read(t), store, static_cast<TileIndex>(t));
    for (const MarkedPoint& p : points) found.rows.insert(tiling.tiles[t].row(p.owned));
    found.points.drop(t);
    found.points.append(t, points);
    count += points.size();
  });
  if (count != loops.points()) fail_inconsistent("a loop passes through a point that is not stored");
  return found;
}

}  // namespace lacuna
