// SPDX-License-Identifier: Apache-2.0
#include "engine/levels/evaluate_level.hpp"

#include "engine/halo/eps_balls.hpp"
#include "engine/halo/halo.hpp"
#include "engine/levels/sealed_level.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

// Takes the outputs that are kept, and those of `tiles`, which are not.
void evaluate(const Level& level, std::span<const TileIndex> tiles, std::span<TileConsumer* const> consumers,
              KeptOutputs& kept, Job& job, const TakeOutput& take) {
  const double eps = eps_length(job.config.neighbourhood, level.extent);
  AppendLists<HaloEdge> halo = exchange_halo(level.store, tiles, job);
  Phase phase(job, "evaluate", level.store.tiling().points());
  const auto take_one = [&](TileIndex t, const TileOutput& output) {
    take(t, output);
    phase.advance(level.store.tiling().tiles[t].points);
  };
  kept.for_each(job, take_one);
  evaluate_tiles(
      level.store, tiles, std::move(halo), eps, level.extent, consumers, job,
      [&](TileIndex t, const TileOutput& output) {
        kept.add(t, output);
        take_one(t, output);
      },
      [&](TileIndex t, const TileContent& content) { return kept.find_earlier(t, content); });
  kept.finish();
}

// Those of which the middle point is in the share.
std::vector<TileIndex> tiles_in(const TaskShare& share, std::span<const TileIndex> tiles,
                                const Tiling& tiling) {
  std::vector<TileIndex> mine;
  const double all = static_cast<double>(tiling.points());
  std::uint64_t before = 0;
  auto next = tiles.begin();
  for (TileIndex t = 0; t < tiling.tiles.size() && next != tiles.end(); ++t) {
    const double middle = static_cast<double>(before) + static_cast<double>(tiling.tiles[t].points) / 2;
    const auto task =
        static_cast<std::size_t>(middle / all * static_cast<double>(share.tasks));  // or `tasks`
    before += tiling.tiles[t].points;
    if (*next != t) continue;
    if (std::min(task, share.tasks - 1) == share.task) mine.push_back(t);
    ++next;
  }
  return mine;
}

}  // namespace

Totals evaluate_level(const Level& level, std::span<TileConsumer* const> consumers, Job& job,
                      const TakeOutput& take) {
  Totals totals(level.extent);
  std::mutex mutex;
  KeptOutputs kept = find_outputs(level, PartReader::Check::kWhole, job);
  evaluate(level, kept.missing(), consumers, kept, job, [&](TileIndex t, const TileOutput& output) {
    take(t, output);
    const std::lock_guard lock(mutex);
    totals.add(output);
  });
  return totals;
}

void evaluate_share(const Level& level, const TaskShare& share, std::span<TileConsumer* const> consumers,
                    Job& job) {
  KeptOutputs kept = find_outputs(level, PartReader::Check::kTable, job);
  const std::vector<TileIndex> tiles = tiles_in(share, kept.missing(), level.store.tiling());
  evaluate(level, tiles, consumers, kept, job, [](TileIndex, const TileOutput&) {});
}

}  // namespace lacuna
