#include "engine/boundary/tangential/star_lists.hpp"

#include "engine/store/merge_runs.hpp"

#include <utility>

namespace lacuna {

StarSpill::StarSpill(const Job& job, const std::string& name, std::size_t tiles, std::uint64_t budget)
    : stars_(job.file(name + "-stars"), tiles, budget / 4),
      corners_(job.file(name + "-corners"), tiles, budget - budget / 4) {}

void StarSpill::append(TileIndex tile, StoredStars stars) {
  const auto before = static_cast<std::uint32_t>(corners_.count(tile));
  for (StoredStar& star : stars.stars) star.place.begin += before;
  stars_.append(tile, stars.stars);
  corners_.append(tile, stars.corners);
}

StoredStars StarSpill::read(TileIndex tile) const {
  StoredStars stars{stars_.read(tile), corners_.read(tile)};
  merge_runs(stars.stars, [](const StoredStar& a, const StoredStar& b) { return a.owned < b.owned; });
  return stars;
}

void StarSpill::drop(TileIndex tile) {
  stars_.drop(tile);
  corners_.drop(tile);
}

StarLists::StarLists(const TileStore& store, const Job& job)
    : waiting(job.file("waiting"), store.tiling().tiles.size(), job.memory.spills / 16),
      waiting_neighbours(job.file("waiting-neighbours"), store.tiling().tiles.size(), job.memory.spills / 16),
      waiting_nearby(job.file("waiting-nearby"), store.tiling().tiles.size(), job.memory.spills / 16),
      around(store.tiling().tiles.size()),
      sites(job.file("sites")),
      active(store.tiling().row_count()),
      unmeasured(store.tiling().row_count()),
      found(job, "found", store.tiling().tiles.size(), job.memory.spills / 16),
      open(job, "open", store.tiling().tiles.size(), job.memory.spills / 8),
      wedges(job.file("wedges"), store.tiling().tiles.size(), job.memory.spills / 8),
      open_wedges(job.file("open-wedges"), store.tiling().tiles.size(), job.memory.spills / 16) {}

void StarLists::drop_waiting(TileIndex tile) {
  waiting.drop(tile);
  waiting_neighbours.drop(tile);
  waiting_nearby.drop(tile);
  found.drop(tile);
  open.drop(tile);
}

}  // namespace lacuna
