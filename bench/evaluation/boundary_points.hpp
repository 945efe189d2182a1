// SPDX-License-Identifier: Apache-2.0
// Scores of the classification of points as boundary points.
#pragma once

#include "io/explain/matching/match_loops.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lacuna::evaluation {
using namespace matching;

struct PointScores {
  std::optional<double> precision;  // share of the flagged that are right; empty if nothing is flagged
  std::optional<double> recall;     // share of the true that are flagged; empty if nothing is true
  std::optional<double> f1;         // their harmonic mean; empty if nothing is flagged or true
};

// Returns both, and F1. A part that is empty counts as 0 in F1.
PointScores point_scores(std::optional<double> precision, std::optional<double> recall);

struct PointAccuracy {
  std::size_t flagged = 0, truth = 0;  // places
  PointScores by_id;                   // flagged and true at the same place
  PointScores within_tolerance;        // a flagged place counts near a true edge, a true one near a flagged
};

// Points at one place count once. The true points are the vertices of all loops given. Within the tolerance
// of the rule, the loops' edges count instead, since a boundary is a curve. Where few points of a curve were
// sampled, places between them are on it as well.
PointAccuracy score_points(std::span<const std::uint64_t> flagged, std::span<const TrueLoop> truth,
                           std::span<const Eigen::Vector3d> positions,
                           std::span<const std::uint64_t> stand_ins, const MatchRule& rule);

}  // namespace lacuna::evaluation
