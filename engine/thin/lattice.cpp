#include "engine/thin/lattice.hpp"

#include <algorithm>
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

LatticePlace Lattice::place_of(const Eigen::Vector3d& position) const {
  LatticePlace place;
  for (int axis = 0; axis < 3; ++axis) {
    const double edges = position[axis] * per_length_;
    const double cell = std::floor(edges) + 0.0;  // -0 is 0
    place.cell[axis] = cell;
    // A point just below a corner may round up to it. Not a number where the cell is not finite.
    const double offset = std::min((edges - cell) * 0x1p32, 0x1p32 - 1);
    place.offset[static_cast<std::size_t>(axis)] =
        std::isfinite(cell) ? static_cast<std::uint32_t>(offset) : 0;
  }
  place.hash = hash_of(place.cell);
  return place;
}

}  // namespace lacuna
