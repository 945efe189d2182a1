// SPDX-License-Identifier: Apache-2.0
// How well points were classified as boundary points.
#pragma once

#include "tools/matching/true_loops.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::evaluation {
using namespace matching;

struct PointScores {
  std::optional<double> precision;  // right of the flagged; none: nothing is flagged
  std::optional<double> recall;     // flagged of the true; none: nothing is true
  std::optional<double> f1;         // their harmonic mean; none: nothing is flagged or true
};

struct PointAccuracy {
  std::size_t flagged = 0, truth = 0;  // places
  PointScores by_id;                   // at the same place
  PointScores within_radius;           // flagged ones near a true edge; true ones near a flagged one
};

// Points at one place count once. The truth is the vertices of all loops given. Within the radius, it is
// their edges, since a boundary is a curve. Where few of its points were sampled, those between them are on
// it as well.
PointAccuracy score_points(std::span<const std::uint64_t> flagged, std::span<const TrueLoop> truth,
                           std::span<const Eigen::Vector3d> positions,
                           std::span<const std::uint64_t> stand_ins, double radius);

}  // namespace lacuna::evaluation
