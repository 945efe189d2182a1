// SPDX-License-Identifier: Apache-2.0
// Decides which true loops were found, and which loops are false.
#pragma once

#include "io/explain/matching/true_loops.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::matching {

// A loop lies on a true loop if `share` of its points are within their tolerance of an edge of the true loop.
// It covers the true loop if `share` of the true loop's vertices are within theirs of an edge of the loop. It
// matches if both hold.
//
// A loop that matches none may lie on all true loops that count together. Then `share` of its points are
// within the tolerance of an edge of any. Such a loop is `joined` if it covers one of them, or lies on no
// single one; then it runs along several. Else it is `parted`: it lies on one, and covers too little of it.
struct MatchRule {
  double tolerance = 0;                // a length: the least anywhere
  std::span<const double> of_place{};  // tolerances of points, by id; empty: `tolerance` everywhere
  double share = 0.7;
  std::size_t min_vertices = 8;  // true loops with fewer do not count, and neither do narrow ones

  double tolerance_at(std::uint64_t id) const {
    return of_place.empty() ? tolerance : std::max(tolerance, of_place[id]);
  }
};

enum class EdgeDecision {
  kFound,     // the first loop that matches its true loop
  kRepeated,  // a later one
  kShort,     // matches only a true loop that does not count: neither right nor wrong
  kJoined,    // matches none, but runs along several that count
  kParted,    // matches none, but is a part of one that counts
  kStep,      // along a step of density; match_loops does not know it
  kFalse,     // nothing of the above
};

struct LoopMatch {
  EdgeDecision verdict = EdgeDecision::kFalse;
  // The best of the true loops that it matches: counting before short, then by the smaller share, then by
  // both, then the first. For a joined loop it is the one of which it covers most, for a parted one the one
  // on which most of it lies. For a false loop it is the best of all that are near. Empty if no true loop is
  // near.
  std::optional<std::size_t> true_loop;
  double on_any = 0;              // share of its points on the true loops that count
  double on = 0;                  // share of its points on that true loop
  double covered = 0;             // share of that true loop's vertices on it
  std::optional<double> on_step;  // share of its points on steps of density
};

struct TrueMatch {
  bool counts = true;
  std::optional<std::size_t> found_by;  // the first loop that matches; empty if missed
};

struct LoopAccuracy {
  std::vector<LoopMatch> loops;       // in the order given
  std::vector<TrueMatch> true_loops;  // in the order given
};

// Ids are places in `positions`. Cost: n log n, but the product of the numbers of loops if all loops are near
// one another.
LoopAccuracy match_loops(std::span<const LoopIds> loops, std::span<const TrueLoop> truth,
                         std::span<const Eigen::Vector3d> positions, const MatchRule& rule);

}  // namespace lacuna::matching
