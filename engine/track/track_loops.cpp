// SPDX-License-Identifier: Apache-2.0
#include "engine/track/track_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "engine/track/near_loops.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

namespace lacuna {
namespace {

// A loop of any level, and the levels of its track.
struct TrackedLoop {
  std::uint32_t level, loop;  // the number within the level
  std::uint32_t first, last;
  std::uint32_t first_of_kind;  // of the track that has the loops of its own kind alone
  LoopEvidence evidence;
  double log_odds = 0;
};

// Returns all loops as `near_loops` numbers them, each with a track of its own.
std::vector<TrackedLoop> loops_of(std::span<const LevelLoops> levels) {
  std::vector<TrackedLoop> loops;
  for (std::uint32_t l = 0; l < levels.size(); ++l) {
    for (std::uint32_t i = 0; i < levels[l].loops.size(); ++i)
      loops.push_back({l, i, l, l, l, levels[l].loops.evidence(i)});
  }
  return loops;
}

// Follows each hole up to its last level, and down to its first one. Pairs and their levels ascend, so each
// way takes one pass.
void follow(std::span<const NearLoops> pairs, std::vector<TrackedLoop>& loops) {
  std::vector<NearLoops> links;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(links),
               [&](const NearLoops& p) { return p.is_same_hole() && loops[p.a].level != loops[p.b].level; });
  for (std::size_t i = links.size(); i-- > 0;)
    loops[links[i].a].last = std::max(loops[links[i].a].last, loops[links[i].b].last);
  std::sort(links.begin(), links.end(),
            [](const NearLoops& x, const NearLoops& y) { return x.b != y.b ? x.b < y.b : x.a < y.a; });
  for (const NearLoops& link : links) {
    const TrackedLoop& from = loops[link.a];
    TrackedLoop& to = loops[link.b];
    to.first = std::min(to.first, from.first);
    if (to.evidence.kind == from.evidence.kind)
      to.first_of_kind = std::min(to.first_of_kind, from.first_of_kind);
  }
}

// Adds the persistence to the evidence: 0 where the track ends at all points, or before the spacing.
void rate(std::span<const LevelLoops> levels, std::vector<TrackedLoop>& loops) {
  for (TrackedLoop& loop : loops) {
    const double spacing = loop.evidence.spacing, edge = levels[loop.last].edge;
    if (edge > spacing) loop.evidence.persistence = octaves(edge / spacing);
    loop.log_odds = log_odds(loop.evidence);
  }
}

// By loop: the loops of the highest rank are chosen first.
std::vector<double> ranks_of(std::span<const TrackedLoop> loops) {
  constexpr double kSure = 4;         // log-odds from which on loops are equally good
  constexpr double kLevelCost = 0.8;  // of a level, in log-odds: fine curves are closer to the hole
  std::vector<double> ranks;
  for (const TrackedLoop& loop : loops) {
    const double level = loop.level + 0.5 * loop.evidence.is_coarse;
    ranks.push_back(std::min(loop.log_odds, kSure) - kLevelCost * level);
  }
  return ranks;
}

// Goes down from the highest rank. A loop is chosen unless a chosen loop is at the same place. At the same
// place are loops that run along half of it, and loops that run along loops of the same hole. A coarse
// cell may hold an opening and the curve around it. So a loop of the other kind that begins at its level, or a
// finer one, is a curve of its own.
std::vector<std::uint32_t> choose(std::span<const NearLoops> pairs, std::span<const TrackedLoop> loops) {
  const std::vector<double> ranks = ranks_of(loops);
  struct Neighbour {
    std::uint32_t loop;
    bool is_same;
  };
  std::vector<std::uint32_t> begin(ranks.size() + 1);
  for (const NearLoops& p : pairs) ++begin[p.a + 1], ++begin[p.b + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Neighbour> neighbours(2 * pairs.size());
  std::vector<std::uint32_t> end(begin.begin(), begin.end() - 1);
  for (const NearLoops& p : pairs) {
    neighbours[end[p.a]++] = {p.b, p.is_same_hole()};
    neighbours[end[p.b]++] = {p.a, p.is_same_hole()};
  }

  std::vector<std::uint32_t> order(ranks.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    return ranks[x] != ranks[y] ? ranks[x] > ranks[y] : x < y;
  });
  constexpr std::uint32_t kNone = UINT32_MAX;
  enum class Standing : std::uint8_t { kOpen, kChosen, kCovered };
  std::vector<Standing> standing(ranks.size(), Standing::kOpen);
  std::vector<std::uint32_t> chosen, place, reached_by(ranks.size(), kNone);
  for (const std::uint32_t loop : order) {
    if (standing[loop] != Standing::kOpen) continue;
    standing[loop] = Standing::kChosen;
    chosen.push_back(loop);
    place.assign(1, loop);
    while (!place.empty()) {
      const std::uint32_t at = place.back();
      place.pop_back();
      for (std::uint32_t n = begin[at]; n < begin[at + 1]; ++n) {
        const auto& [other, is_same] = neighbours[n];
        if (standing[other] == Standing::kChosen) continue;
        if (at != loop && loops[other].evidence.kind != loops[loop].evidence.kind &&
            loops[other].first_of_kind <= loops[loop].level)
          continue;
        if (std::exchange(reached_by[other], loop) == loop) continue;
        standing[other] = Standing::kCovered;
        if (is_same) place.push_back(other);
      }
    }
  }
  return chosen;
}

// All of them are chosen.
TrackedLoops all_loops(std::vector<LevelLoops> levels) {
  TrackedLoops tracked;
  const auto count = static_cast<std::uint32_t>(levels.front().loops.size());
  for (std::uint32_t loop = 0; loop < count; ++loop) tracked.loops.chosen.push_back({0, loop});
  tracked.loops.levels.push_back(std::move(levels.front().loops));
  tracked.tracks.resize(count);
  return tracked;
}

}  // namespace

TrackedLoops track_loops(std::vector<LevelLoops> levels, Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper) return all_loops(std::move(levels));
  Phase phase(job.phases, "track", 0);
  const std::vector<NearLoops> pairs = near_loops(levels, job.spill, job.workers);
  std::vector<TrackedLoop> loops = loops_of(levels);
  follow(pairs, loops);
  rate(levels, loops);
  std::vector<std::uint32_t> chosen = choose(pairs, loops);
  const double min_confidence = job.config.selection.min_confidence;
  std::erase_if(chosen, [&](std::uint32_t i) { return probability_of(loops[i].log_odds) < min_confidence; });
  // At most one of several loops with the same points is chosen.
  std::sort(chosen.begin(), chosen.end(), [&](std::uint32_t x, std::uint32_t y) {
    return compare_points(levels[loops[x].level].loops, loops[x].loop, levels[loops[y].level].loops,
                          loops[y].loop) < 0;
  });

  TrackedLoops tracked;
  for (const std::uint32_t i : chosen) {
    const TrackedLoop& loop = loops[i];
    tracked.loops.chosen.push_back({loop.level, loop.loop});
    tracked.tracks.push_back({.confidence = probability_of(loop.log_odds),
                              .evidence = loop.evidence,
                              .first_scale = levels[loop.first].edge,
                              .last_scale = levels[loop.last].edge});
  }
  for (LevelLoops& level : levels) tracked.loops.levels.push_back(std::move(level.loops));
  return tracked;
}

}  // namespace lacuna
