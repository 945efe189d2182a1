// SPDX-License-Identifier: Apache-2.0
// measures: how far apart the points of a scan are, and how large its loops.
//
// Idea: the truth knows places alone. So the spacing of a place is measured at its nearest points. The size,
// kind and width of a loop follow, by the rules for found loops.
//
// Source: docs/evaluate.md. Cost: log n for a place, and n log n for the tree of the points.
#pragma once

#include "engine/model/loop.hpp"
#include "io/explain/matching/match_loops.hpp"
#include "io/explain/matching/nearest.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

using namespace matching;

// Returns the mean distance to the 4 nearest other points, or to all if there are fewer; 0 for a single
// point. The place is a point of the tree, whose points are distinct.
double spacing_at(const Eigen::Vector3d& point, const PointTree& tree);

// Returns the spacing of a place, also where it is sampled in lines. An even sampling of this spacing has its
// 32nd neighbour as far away. Returns 0 where there are no more than 32 points. Cost: log n.
double spacing_of_place(const Eigen::Vector3d& place, const PointTree& tree);

// Returns the median over the points; 0 for fewer than two. The points are finite and distinct. If there are
// more than 130,000 points, the function takes as many, evenly spread. Cost: n log n, for the tree.
// `tree` has these points.
double median_spacing(std::span<const Eigen::Vector3d> points, const PointTree& tree);

double median(std::vector<double> values);  // the upper one of two; 0 without values

// In units of the scan.
struct LoopSize {
  double perimeter = 0;             // sum of the edges' lengths
  double diameter = 0;              // largest distance between two vertices
  double area = 0;                  // projected along its normal; of an open loop: closed over its centre
  Eigen::Vector3d centre{0, 0, 0};  // mean of the vertices
};

// Ids are places in `positions`, which are finite there. A loop without edges has a size of 0.
LoopSize size_of(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions);
LoopSize size_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions);

// Returns whether a true loop goes around a hole or around a piece of surface.
// Uses the rule for found loops (engine/loops/measure_loops.hpp): the surface is where the means of the 15
// nearest points are. `points` are the points of the tree, and ids are places in `positions`. Returns nothing
// for fewer than three ids.
std::optional<LoopKind> kind_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions,
                                std::span<const Eigen::Vector3d> points, const PointTree& tree);

// ---- How many true holes are found, by their width: how small a hole a program finds

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
