// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/lattice.hpp"

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

TEST_CASE("the origin of the coordinates lies at 0.382 of a cell of the lattice") {
  const Lattice lattice(0.5);
  CHECK(lattice.place_of({0.1, 0.5, 1.7}).cell == Eigen::Vector3d(0, 1, 3));
  CHECK(lattice.place_of({-0.1, -0.5, -0.7}).cell == Eigen::Vector3d(0, -1, -2));
  CHECK(lattice.place_of({500'000.3, 5'400'000.1, 0}).cell == Eigen::Vector3d(1'000'000, 10'800'000, 0));
  CHECK(lattice.place_of({0.059, 0.559, -0.441}).squared_offset == Approx(0).margin(1e-12));  // the middle
  CHECK(lattice.place_of({0.309, 0.309, 0.309}).squared_offset == Approx(0.75));              // a corner
  CHECK(lattice.place_of({-0.0, 0, 0}).hash == lattice.place_of({0, 0, 0}).hash);
  CHECK_FALSE(Lattice(1e-100).place_of({1e300, 0, 0}).cell.allFinite());
}

}  // namespace
}  // namespace lacuna
