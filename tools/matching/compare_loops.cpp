// SPDX-License-Identifier: Apache-2.0
#include "tools/matching/compare_loops.hpp"

#include "tools/matching/match_loops.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lacuna::matching {
namespace {

// Appends the points of all loops to the positions; returns the loops by place there.
std::vector<LoopIds> place(std::span<const ComparedLoop> loops, std::vector<Eigen::Vector3d>& positions) {
  std::vector<LoopIds> placed;
  for (const ComparedLoop& loop : loops) {
    LoopIds& ids = placed.emplace_back();
    for (const Eigen::Vector3d& point : loop.points) {
      ids.push_back(positions.size());
      positions.push_back(point);
    }
  }
  return placed;
}

// Whether a loop is of the same hole, or of a part of it: half of one runs along the other.
bool is_related(const LoopMatch& match) {
  constexpr double kHalf = 0.5;
  return match.true_loop &&
         (match.verdict != EdgeDecision::kFalse || match.on >= kHalf || match.covered >= kHalf);
}

bool is_as_large(const LoopMeasures& a, const LoopMeasures& b) {
  constexpr double kTenth = 0.1;
  return std::abs(a.area - b.area) <= kTenth * std::max(a.area, b.area);
}

}  // namespace

std::string_view name_of(Change change) {
  constexpr std::string_view kNames[] = {"same", "changed", "closed", "new"};
  return kNames[static_cast<std::size_t>(change)];
}

std::vector<LoopChange> compare_loops(std::span<const ComparedLoop> before,
                                      std::span<const ComparedLoop> after, double tolerance) {
  std::vector<Eigen::Vector3d> positions;
  const std::vector<LoopIds> first = place(before, positions), second = place(after, positions);
  const MatchRule rule{.tolerance = tolerance, .min_vertices = 0};
  const std::vector<std::uint64_t> same_places = stand_ins(positions);
  const auto matches = [&](std::span<const LoopIds> loops, std::span<const LoopIds> others) {
    const std::vector<TrueLoop> truth = loops_through(others, same_places);
    return match_loops(loops, truth, positions, rule).loops;
  };
  std::vector<LoopChange> changes;
  std::vector<bool> is_listed(before.size());
  const std::vector<LoopMatch> onto_before = matches(second, first), onto_after = matches(first, second);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const LoopMatch& match = onto_before[i];
    if (!is_related(match)) {
      changes.push_back({Change::kNew, {}, i});
      continue;
    }
    const std::size_t b = *match.true_loop;
    is_listed[b] = true;
    const bool is_match = match.verdict == EdgeDecision::kFound || match.verdict == EdgeDecision::kRepeated;
    const bool is_same = is_match && is_as_large(before[b].measures, after[i].measures);
    changes.push_back({is_same ? Change::kSame : Change::kChanged, b, i});
  }
  for (std::size_t b = 0; b < before.size(); ++b) {
    if (is_listed[b]) continue;
    const LoopMatch& match = onto_after[b];
    if (is_related(match)) {
      changes.push_back({Change::kChanged, b, match.true_loop});
    } else {
      changes.push_back({Change::kClosed, b, {}});
    }
  }
  return changes;
}

}  // namespace lacuna::matching
