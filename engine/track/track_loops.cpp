#include "engine/track/track_loops.hpp"

#include "engine/store/column_writer.hpp"
#include "engine/track/confidence.hpp"
#include "engine/track/near_loops.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace lacuna {
namespace {

// A loop of any level, by its number, and what its track tells.
struct TrackedLoop {
  std::uint32_t level, loop;  // the number within the level
  double own;                 // clearness times surface
  double best;                // the largest of the track
  std::uint32_t first, last;  // levels of the track
  double log_odds = 0;
  double rank = 0;  // those of the highest rank are chosen first
};

bool is_same_hole(const NearLoops& pair) {
  constexpr float kSame = 0.7f;
  return pair.of_a >= kSame && pair.of_b >= kSame;
}

std::vector<TrackedLoop> loops_of(std::span<const LevelLoops> levels) {
  std::vector<TrackedLoop> loops;
  for (std::uint32_t l = 0; l < levels.size(); ++l) {
    for (std::uint32_t i = 0; i < levels[l].loops.size(); ++i) {
      const LoopEvidence& e = levels[l].evidence[i];
      const double own = e.clearness * e.surface;
      loops.push_back({l, i, own, own, l, l});
    }
  }
  return loops;
}

// Follows each hole up to its last level, and down to its first one. Pairs ascend, and levels with them: one pass
// each way.
void follow(std::span<const NearLoops> pairs, std::vector<TrackedLoop>& loops) {
  std::vector<double> above(loops.size()), below(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) above[i] = below[i] = loops[i].own;
  const auto is_link = [&](const NearLoops& p) {
    return is_same_hole(p) && loops[p.a].level != loops[p.b].level;
  };
  for (std::size_t i = pairs.size(); i-- > 0;) {
    const auto& [a, b, of_a, of_b] = pairs[i];
    if (!is_link(pairs[i])) continue;
    above[a] = std::max(above[a], above[b]);
    loops[a].last = std::max(loops[a].last, loops[b].last);
  }
  std::vector<NearLoops> upward;  // by the upper loop
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(upward), is_link);
  std::sort(upward.begin(), upward.end(), [](const NearLoops& x, const NearLoops& y) {
    return x.b != y.b ? x.b < y.b : x.a < y.a;
  });
  for (const auto& [a, b, of_a, of_b] : upward) {
    below[b] = std::max(below[b], below[a]);
    loops[b].first = std::min(loops[b].first, loops[a].first);
  }
  for (std::size_t i = 0; i < loops.size(); ++i) loops[i].best = std::max(above[i], below[i]);
}

// The logarithm to the base 2, by straight lines between powers of two: within 0.09, and the same on every machine.
double octaves(double ratio) {
  const int power = std::ilogb(ratio);
  return power + std::ldexp(ratio, -power) - 1;
}

// 0: it ends at all points, or before the spacing.
double persistence(double last_edge, double spacing) {
  return last_edge > spacing ? octaves(last_edge / spacing) : 0;
}

void rate(std::span<const LevelLoops> levels, std::vector<TrackedLoop>& loops, Job& job) {
  constexpr double kSure = 2;         // log-odds from which on loops are equally good
  constexpr double kLevelCost = 0.4;  // of a level, in log-odds: fine curves are closer to the hole
  std::size_t first = 0;
  for (const LevelLoops& level : levels) {
    for_each_loop(level.loops, job,
                  [&](std::size_t i, std::span<const StoredLoopPoint> points, Scratch& scratch) {
                    TrackedLoop& loop = loops[first + i];
                    const LoopEvidence& e = level.evidence[i];
                    const auto [perimeter, area] = shape_of(points, scratch);
                    loop.log_odds = log_odds({.clearness = e.clearness,
                                              .surface = e.surface,
                                              .sampling_gap = e.sampling_gap,
                                              .roundness = roundness(perimeter, area, e.spacing),
                                              .best = loop.best,
                                              .persistence = persistence(levels[loop.last].edge, e.spacing),
                                              .is_first_level = loop.level == 0});
                    loop.rank = std::min(loop.log_odds, kSure) - kLevelCost * (loop.level + 0.5 * e.is_coarse);
                  });
    first += level.loops.size();
  }
}

// From the highest rank on: a loop stands unless it is at the place of one that does. At a place are the loops that
// run along half of it, and those that run along loops of the same hole.
std::vector<std::uint32_t> choose(std::span<const NearLoops> pairs, std::span<const TrackedLoop> loops) {
  struct Neighbour {
    std::uint32_t loop;
    bool is_same;
  };
  std::vector<std::uint32_t> begin(loops.size() + 1);
  for (const NearLoops& p : pairs) ++begin[p.a + 1], ++begin[p.b + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Neighbour> neighbours(2 * pairs.size());
  std::vector<std::uint32_t> end(begin.begin(), begin.end() - 1);
  for (const NearLoops& p : pairs) {
    neighbours[end[p.a]++] = {p.b, is_same_hole(p)};
    neighbours[end[p.b]++] = {p.a, is_same_hole(p)};
  }

  std::vector<std::uint32_t> order(loops.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    return loops[x].rank != loops[y].rank ? loops[x].rank > loops[y].rank : x < y;
  });
  constexpr std::uint32_t kNone = UINT32_MAX;
  enum class Standing : std::uint8_t { kOpen, kChosen, kCovered };
  std::vector<Standing> standing(loops.size(), Standing::kOpen);
  std::vector<std::uint32_t> chosen, place, reached_by(loops.size(), kNone);
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
        if (std::exchange(reached_by[other], loop) == loop) continue;
        standing[other] = Standing::kCovered;
        if (is_same) place.push_back(other);
      }
    }
  }
  return chosen;
}

// Whether the points of a loop come before those of another: by first id, then short ones first, then by all ids.
bool comes_first(const PlacedLoops& a, std::size_t i, const PlacedLoops& b, std::size_t j) {
  ColumnReader<StoredLoopPoint> of_a(a.points), of_b(b.points);
  const auto id_a = [&](std::uint64_t k) { return of_a[a.offsets[i] + k].point.id; };
  const auto id_b = [&](std::uint64_t k) { return of_b[b.offsets[j] + k].point.id; };
  if (id_a(0) != id_b(0)) return id_a(0) < id_b(0);
  if (a.count(i) != b.count(j)) return a.count(i) < b.count(j);
  for (std::uint64_t k = 1; k < a.count(i); ++k) {
    if (id_a(k) != id_b(k)) return id_a(k) < id_b(k);
  }
  return false;
}

}  // namespace

TrackedLoops track_loops(std::vector<LevelLoops> levels, Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper) {
    std::vector<LoopTrack> tracks(levels.front().loops.size());
    return {std::move(levels.front().loops), std::move(tracks)};
  }
  Phase phase(job, "track", 0);
  std::vector<TrackedLoop> loops = loops_of(levels);
  const std::vector<NearLoops> pairs = near_loops(levels, job);
  follow(pairs, loops);
  rate(levels, loops, job);
  std::vector<std::uint32_t> chosen = choose(pairs, loops);
  const double min_confidence = job.config.selection.min_confidence;
  std::erase_if(chosen, [&](std::uint32_t i) { return probability_of(loops[i].log_odds) < min_confidence; });
  std::sort(chosen.begin(), chosen.end(), [&](std::uint32_t x, std::uint32_t y) {
    return comes_first(levels[loops[x].level].loops, loops[x].loop, levels[loops[y].level].loops, loops[y].loop);
  });

  TrackedLoops tracked{.loops = {.points = Column<StoredLoopPoint>(job.file("tracked-loops"))}, .tracks = {}};
  ColumnWriter<StoredLoopPoint> writer(tracked.loops.points);
  for (const std::uint32_t i : chosen) {
    const TrackedLoop& loop = loops[i];
    const LevelLoops& level = levels[loop.level];
    level.loops.for_each_point(loop.loop, [&](const StoredLoopPoint& p) { writer.add(p); });
    tracked.loops.offsets.push_back(tracked.loops.offsets.back() + level.loops.count(loop.loop));
    tracked.tracks.push_back({.confidence = probability_of(loop.log_odds),
                              .persistence = persistence(levels[loop.last].edge, level.evidence[loop.loop].spacing),
                              .first_scale = levels[loop.first].edge,
                              .last_scale = levels[loop.last].edge});
  }
  writer.finish();
  return tracked;
}

}  // namespace lacuna
