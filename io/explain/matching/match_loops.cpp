// SPDX-License-Identifier: Apache-2.0
#include "io/explain/matching/match_loops.hpp"

#include <map>
#include <numeric>
#include <tuple>

namespace lacuna::matching {
namespace {

std::array<double, 3> place_of(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

void sort_once(std::vector<std::uint64_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

std::vector<std::uint64_t> stand_ins(std::span<const Eigen::Vector3d> positions) {
  std::vector<std::uint64_t> stands_for(positions.size());
  std::iota(stands_for.begin(), stands_for.end(), std::uint64_t{0});
  std::vector<std::uint64_t> order;
  for (std::uint64_t id = 0; id < positions.size(); ++id) {
    if (positions[id].allFinite()) order.push_back(id);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint64_t a, std::uint64_t b) {
    return place_of(positions[a]) < place_of(positions[b]);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (place_of(positions[order[i]]) == place_of(positions[order[i - 1]])) {
      stands_for[order[i]] = stands_for[order[i - 1]];
    }
  }
  return stands_for;
}

std::vector<TrueLoop> loops_through(std::span<const LoopIds> ids, std::span<const std::uint64_t> stand_ins) {
  std::vector<TrueLoop> loops;
  for (const LoopIds& line : ids) {
    TrueLoop& loop = loops.emplace_back();
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::uint64_t next = line[i + 1 < line.size() ? i + 1 : 0];
      loop.vertices.push_back(stand_ins[line[i]]);
      loop.edges.push_back({stand_ins[line[i]], stand_ins[next]});
    }
    sort_once(loop.vertices);
  }
  return loops;
}

EdgeTree tree_of_truth(std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions) {
  std::vector<Segment> edges;
  for (std::size_t loop = 0; loop < truth.size(); ++loop) {
    for (const auto& [a, b] : truth[loop].edges) edges.push_back({positions[a], positions[b], loop});
  }
  return EdgeTree(std::move(edges));
}

namespace {

using Positions = std::span<const Eigen::Vector3d>;

struct Shares {
  double on = 0, covered = 0;
};

struct Overlap {
  std::map<std::size_t, Shares> of;  // the true loops that the loop comes near to
  double on_any = 0;                 // share of its points on true loops that count
};

EdgeTree tree_of_loops(std::span<const LoopIds> loops, Positions positions) {
  std::vector<Segment> edges;
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    const LoopIds& ids = loops[loop];
    for (std::size_t i = 0; i < ids.size(); ++i) {
      edges.push_back({positions[ids[i]], positions[ids[i + 1 < ids.size() ? i + 1 : 0]], loop});
    }
  }
  return EdgeTree(std::move(edges));
}

bool counts(const TrueLoop& loop, const MatchRule& rule) {
  return !loop.is_narrow && loop.vertices.size() >= rule.min_vertices;
}

std::vector<Overlap> overlaps_of(std::span<const LoopIds> loops, std::span<const TrueLoop> truth,
                                 Positions positions, const MatchRule& rule) {
  std::vector<Overlap> overlaps(loops.size());
  std::vector<std::size_t> near;
  const EdgeTree true_edges = tree_of_truth(truth, positions);
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    const auto points = static_cast<double>(loops[loop].size());
    std::size_t on_any = 0;
    std::map<std::size_t, std::size_t> on;  // points, by true loop
    for (const std::uint64_t id : loops[loop]) {
      true_edges.owners_within(positions[id], rule.tolerance_at(id), near);
      for (const std::size_t hit : near) ++on[hit];
      on_any +=
          std::any_of(near.begin(), near.end(), [&](std::size_t hit) { return counts(truth[hit], rule); });
    }
    for (const auto& [hit, on_it] : on) overlaps[loop].of[hit].on = static_cast<double>(on_it) / points;
    if (on_any > 0) overlaps[loop].on_any = static_cast<double>(on_any) / points;
  }
  const EdgeTree loop_edges = tree_of_loops(loops, positions);
  for (std::size_t hit = 0; hit < truth.size(); ++hit) {
    const double share = 1 / static_cast<double>(truth[hit].vertices.size());
    std::map<std::size_t, std::size_t> covered;  // vertices, by loop
    for (const std::uint64_t id : truth[hit].vertices) {
      loop_edges.owners_within(positions[id], rule.tolerance_at(id), near);
      for (const std::size_t loop : near) ++covered[loop];
    }
    for (const auto& [loop, vertices] : covered) {
      overlaps[loop].of[hit].covered = static_cast<double>(vertices) * share;
    }
  }
  return overlaps;
}

bool matches(const Shares& shares, const MatchRule& rule) {
  return shares.on >= rule.share && shares.covered >= rule.share;
}

// Rates a loop that matches no true loop, but lies on all counting true loops together.
LoopMatch joined_or_parted(const Overlap& overlap, std::span<const TrueMatch> truth, const MatchRule& rule) {
  LoopMatch most_on, most_covered;
  for (const auto& [hit, shares] : overlap.of) {
    if (!truth[hit].counts) continue;
    const LoopMatch match = {
        .true_loop = hit, .on_any = overlap.on_any, .on = shares.on, .covered = shares.covered};
    if (!most_on.true_loop || shares.on > most_on.on) most_on = match;
    if (!most_covered.true_loop || shares.covered > most_covered.covered) most_covered = match;
  }
  const bool joined = most_covered.covered >= rule.share || most_on.on < rule.share;
  LoopMatch& best = joined ? most_covered : most_on;
  best.verdict = joined ? EdgeDecision::kJoined : EdgeDecision::kParted;
  return best;
}

LoopMatch best_match(const Overlap& overlap, std::span<const TrueMatch> truth, const MatchRule& rule) {
  const auto rank = [&](std::size_t hit, const Shares& shares) {
    const bool match = matches(shares, rule);
    return std::tuple(match, match && truth[hit].counts, std::min(shares.on, shares.covered),
                      shares.on + shares.covered);
  };
  LoopMatch best;
  std::tuple<bool, bool, double, double> highest;
  for (const auto& [hit, shares] : overlap.of) {
    if (best.true_loop && rank(hit, shares) <= highest) continue;
    highest = rank(hit, shares);
    best = {.true_loop = hit, .on_any = overlap.on_any, .on = shares.on, .covered = shares.covered};
  }
  if (best.true_loop && matches({best.on, best.covered}, rule)) {
    best.verdict = truth[*best.true_loop].counts ? EdgeDecision::kFound : EdgeDecision::kShort;
  } else if (overlap.on_any >= rule.share) {
    return joined_or_parted(overlap, truth, rule);
  }
  return best;
}

}  // namespace

LoopAccuracy match_loops(std::span<const LoopIds> loops, std::span<const TrueLoop> truth,
                         std::span<const Eigen::Vector3d> positions, const MatchRule& rule) {
  LoopAccuracy result;
  for (const TrueLoop& loop : truth) {
    result.true_loops.push_back({.counts = counts(loop, rule)});
  }
  const std::vector<Overlap> overlaps = overlaps_of(loops, truth, positions, rule);
  std::vector<bool> taken(truth.size());
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    for (const auto& [hit, shares] : overlaps[loop].of) {
      if (matches(shares, rule) && !result.true_loops[hit].found_by) result.true_loops[hit].found_by = loop;
    }
    LoopMatch match = best_match(overlaps[loop], result.true_loops, rule);
    if (match.verdict == EdgeDecision::kFound) {
      if (taken[*match.true_loop]) match.verdict = EdgeDecision::kRepeated;
      taken[*match.true_loop] = true;
    }
    result.loops.push_back(match);
  }
  return result;
}

}  // namespace lacuna::matching
