// SPDX-License-Identifier: Apache-2.0
// How many true holes are found, by their width: how small a hole a program finds.
#pragma once

#include "io/explain/matching/match_loops.hpp"
#include "io/explain/matching/nearest.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace lacuna::evaluation {

using matching::PointTree;
using namespace matching;

// Returns the width of a hole, 2 area / perimeter, in local spacings: the mean of spacing_at() over its
// vertices. `points` are the points of the tree, and the vertices are among them. Returns nothing for an
// outer curve, and for a loop without a kind or a spacing. A loop of a mesh gets its kind from kind_of().
std::optional<double> hole_width(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions,
                                 std::span<const Eigen::Vector3d> points, const PointTree& tree);

struct Tally {
  std::size_t found = 0, all = 0;
};

// Spacings. A class of widths begins at one of these, and ends before the next; the last one has no end.
inline constexpr std::array kWidths = {0u, 2u, 3u, 5u, 10u};
using HolesByWidth = std::array<Tally, kWidths.size()>;

// Counts the true loops that count and have a width, by class. Both spans are in the order of the true loops.
HolesByWidth holes_by_width(std::span<const std::optional<double>> widths,
                            std::span<const TrueMatch> matches);

}  // namespace lacuna::evaluation
