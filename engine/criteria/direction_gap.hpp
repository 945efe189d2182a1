// The largest gap between the directions in which a point's neighbours lie (paper, 4.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// Neighbours are named by their rank in neighbour order.
struct DirectionGap {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  double size = 0;             // radians; 2 pi with one direction
  std::size_t used = 0;        // m: neighbours that have a stable direction
  std::uint32_t near = kNone;  // gap neighbours, nearer first; equal with one direction, none without any
  std::uint32_t far = kNone;
};

// `cos_cone`: neighbours with |<n, q - p>| > cos_cone |q - p| have no stable direction.
// `directions` is working space.
struct Direction {
  double angle;
  std::uint32_t rank;
};
DirectionGap largest_gap(std::span<const Eigen::Vector3d> offsets, std::span<const double> distances,
                         const Eigen::Vector3d& normal, double cos_cone, std::vector<Direction>& directions);

}  // namespace lacuna
