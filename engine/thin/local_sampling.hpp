// How a scan samples the surface around one of its points.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// Neighbours of a point that its local sampling is measured from.
inline constexpr std::size_t kSamplingNeighbours = 48;

// Lengths, in units of the scan.
struct LocalSampling {
  double spacing;  // mean distance to the six nearest neighbours
  // Second largest of the nearest distances in six sectors of the tangent plane: along a line of points the
  // distance to the next line. At the border of a surface it may be the distance to the last neighbour.
  double line_distance;
};

// `offsets`: from the point to its nearest neighbours, nearest first, none of them zero. None where fewer
// than `kSamplingNeighbours` are given.
std::optional<LocalSampling> measure_sampling(std::span<const Eigen::Vector3d> offsets);

// The resolution of a scan whose points lie in lines, from a sample of its points; 0 where every point
// counts. Three tenths of all points must lie in lines or, as near a scanner, three tenths of the dense ones.
// These have less than four tenths of the median spacing, and count if they are one in twenty. Six in ten of
// the points in lines have the next line within the resolution. Rounded to one digit. docs/method.md, D has
// how these were chosen.
double resolution_of(const std::vector<LocalSampling>& sample);

}  // namespace lacuna
