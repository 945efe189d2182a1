// SPDX-License-Identifier: Apache-2.0
// The truth about a scan: the loops of its holes and outer edges. Decides which of them were found, and which
// loops are false.
//
// Idea: a loop is a true one if most of each lies near the other. The loop's points lie at the true edges,
// and the true vertices at the loop's edges. One of the two alone is a part of a loop, or several in one.
#pragma once

#include "engine/model/loop.hpp"
#include "io/explain/matching/nearest.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::matching {

using LoopIds = std::vector<std::uint64_t>;  // closed, in the order of its edges, at least one id

// A place may have several points; ids here are the ids of the points that stand for a place (see stand_ins).
struct TrueLoop {
  std::vector<std::uint64_t> vertices;              // ascending, each once
  std::vector<std::array<std::uint64_t, 2>> edges;  // in its order and direction
  std::string name;                                 // its name in the truth; empty if it has none
  std::optional<LoopKind> kind;                     // of loops as text; of a mesh's boundary not known
  bool is_narrow = false;                           // too narrow to count, whatever its length
};

// Returns for each point the lowest id among the points at exactly its coordinates (-0 is 0). A point that is
// not finite gets its own id.
std::vector<std::uint64_t> stand_ins(std::span<const Eigen::Vector3d> positions);

// Sorts ids, and leaves out those that are repeated.
void sort_once(std::vector<std::uint64_t>& ids);

// Returns the closed polygons through `ids`, in their order.
std::vector<TrueLoop> loops_through(std::span<const LoopIds> ids, std::span<const std::uint64_t> stand_ins);

// Holds all edges of the loops; their owners are places in `truth`.
EdgeTree tree_of_truth(std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions);

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
