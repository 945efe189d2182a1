// The largest gap between the directions in which a point's neighbours lie (paper, 4.2).
#pragma once

#include "engine/criteria/offsets.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
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

// Directions in the tangent plane; working space, used again from point to point.
struct Direction {
  double angle;
  std::uint32_t rank;  // of the neighbour
};
struct Directions {
  std::vector<double> x, y, angle;
  std::vector<std::uint32_t> rank, place;
  std::vector<Direction> sorted, merged;
};

// `cos_cone`: neighbours with |<n, q - p>| > cos_cone |q - p| have no stable direction.
DirectionGap largest_gap(const Offsets& offsets, const Eigen::Vector3d& normal, double cos_cone,
                         Directions& directions);

}  // namespace lacuna
