// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/choose_points.hpp"

#include "tests/support/test.hpp"

namespace lacuna {
namespace {

TEST_CASE("cells are counted from the origin, and those at 0 reach a quarter of an edge below it") {
  const Lattice lattice(0.5);
  CHECK(lattice.place_of({0.1, 0.5, 1.7}).cell == Eigen::Vector3d(0, 1, 3));
  CHECK(lattice.place_of({-0.125, -0.126, -0.6}).cell == Eigen::Vector3d(0, -1, -2));
  CHECK(lattice.place_of({500'000.3, 5'400'000.1, 0}).cell == Eigen::Vector3d(1'000'000, 10'800'000, 0));
  CHECK(lattice.place_of({0.25, 0.75, -0.25}).squared_offset == 0);  // the middle of a cell
  CHECK(lattice.place_of({0.5, 0, 0}).squared_offset == 0.75);       // a corner
  CHECK(lattice.place_of({-0.0, 0, 0}).hash == lattice.place_of({0, 0, 0}).hash);
  CHECK_FALSE(Lattice(1e-100).place_of({1e300, 0, 0}).cell.allFinite());
}

}  // namespace
}  // namespace lacuna
