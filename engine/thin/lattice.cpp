// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/lattice.hpp"

#include <bit>
#include <cmath>

namespace lacuna {
namespace {

// The finaliser of MurmurHash3, for each coordinate in turn.
std::uint64_t mixed(std::uint64_t hash, double coordinate) {
  hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * 0xff51afd7ed558ccdULL;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return hash ^ (hash >> 33);
}

}  // namespace

std::uint64_t hash_of(const Eigen::Vector3d& cell) {
  return mixed(mixed(mixed(0, cell.x()), cell.y()), cell.z());
}

PointInCell Lattice::place_of(const Eigen::Vector3d& position) const {
  PointInCell place{.cell = {}, .squared_offset = 0, .hash = 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double edges = position[axis] * per_length_;
    place.cell[axis] = std::floor(-kBelowOrigin <= edges && edges < 0 ? 0 : edges) + 0.0;  // -0 is 0
    const double offset = edges - place.cell[axis] - 0.5;
    place.squared_offset += offset * offset;
  }
  place.hash = hash_of(place.cell);
  return place;
}

}  // namespace lacuna
