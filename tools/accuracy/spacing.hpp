// How far apart the points of a scan are.
#pragma once

#include <span>

#include <Eigen/Core>

namespace lacuna::accuracy {

// The median over the points of the mean distance to their 4 nearest others, or to all where there are fewer;
// 0 for fewer than two points. The points are finite and distinct. Of more than 130,000 points as many are
// asked, evenly spread. Cost: n log n, for the tree.
double median_spacing(std::span<const Eigen::Vector3d> points);

}  // namespace lacuna::accuracy
