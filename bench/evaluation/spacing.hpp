// SPDX-License-Identifier: Apache-2.0
// Computes how far apart the points of a scan are.
#pragma once

#include "io/explain/matching/nearest.hpp"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

using matching::PointTree;

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

}  // namespace lacuna::evaluation
