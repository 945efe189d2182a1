#include "engine/thin/occupied_cells.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

Representative point_of(const Eigen::Vector3d& p, std::size_t id) {
  return {{p.x(), p.y(), p.z(), PointId{id}}, {}};
}

OccupiedCells occupied(const std::vector<Eigen::Vector3d>& positions, const Lattice& lattice) {
  OccupiedCells cells(1);
  for (std::size_t i = 0; i < positions.size(); ++i)
    cells.add(lattice.place_of(positions[i]), point_of(positions[i], i));
  return cells;
}

TEST_CASE("cells of the lattice are counted from the origin of the coordinates") {
  const Lattice lattice(0.5);
  CHECK(lattice.place_of({0.1, 0.5, 1.7}).cell == Eigen::Vector3d(0, 1, 3));
  CHECK(lattice.place_of({-0.1, -0.5, -0.6}).cell == Eigen::Vector3d(-1, -1, -2));
  CHECK(lattice.place_of({500'000.3, 5'400'000.1, 0}).cell == Eigen::Vector3d(1'000'000, 10'800'000, 0));
  CHECK(lattice.place_of({0.25, 0.75, -0.25}).squared_offset == 0);  // the middle of a cell
  CHECK(lattice.place_of({0.5, 0, 0}).squared_offset == 0.75);       // a corner
  CHECK(lattice.place_of({-0.0, 0, 0}).hash == lattice.place_of({0, 0, 0}).hash);
  CHECK_FALSE(Lattice(1e-100).place_of({1e300, 0, 0}).cell.allFinite());
}

TEST_CASE(
    "the point nearest to its middle represents a cell, of several the one with the lowest coordinates, then "
    "id") {
  const Lattice lattice(10);
  const auto representative = [&](const std::vector<Eigen::Vector3d>& positions) {
    const OccupiedCells cells = occupied(positions, lattice);
    REQUIRE(cells.representatives().size() == 1);
    CHECK(cells.at(lattice.place_of(positions[0])).point.id == cells.representatives()[0].point.id);
    return value(cells.representatives()[0].point.id);
  };
  CHECK(representative({{1, 1, 1}}) == 0);
  CHECK(representative({{1, 5, 5}, {4, 5, 5}, {9, 5, 5}}) == 1);
  CHECK(representative({{6, 5, 5}, {4, 5, 5}}) == 1);  // a tie
  CHECK(representative({{4, 5, 5}, {4, 5, 5}}) == 0);  // copies
  CHECK(representative({{-1, -5, -5}, {-4, -5, -5}, {-9, -5, -5}}) == 1);
}

TEST_CASE(
    "the representatives of random points are the nearest to the middles, whatever the order and the parts") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    const Cloud cloud = scattered(2000, seed).noisy(0.1, seed).translated({1e5, -3e5, 7});
    const double edge = 0.13;
    const Lattice lattice(edge);
    std::map<std::array<double, 3>, std::tuple<double, double, double, double>> plain;
    for (const Eigen::Vector3d& p : cloud.positions) {
      const LatticePlace place = lattice.place_of(p);
      CHECK(((place.cell * edge - p).array() <= 1e-9).all());
      CHECK(((place.cell * edge + Eigen::Vector3d::Constant(edge) - p).array() >= -1e-9).all());
      const std::tuple rank(place.squared_offset, p.x(), p.y(), p.z());
      const auto [at, is_new] = plain.try_emplace({place.cell.x(), place.cell.y(), place.cell.z()}, rank);
      at->second = std::min(at->second, rank);
    }
    const auto check = [&](const OccupiedCells& cells) {
      REQUIRE(cells.representatives().size() == plain.size());
      std::size_t wrong = 0;
      for (const Representative& r : cells.representatives()) {
        const LatticePlace place = lattice.place_of(r.point.position());
        wrong += plain.at({place.cell.x(), place.cell.y(), place.cell.z()}) !=
                 std::tuple(place.squared_offset, r.point.x, r.point.y, r.point.z);
      }
      CHECK(wrong == 0);
    };
    check(occupied(cloud.positions, lattice));
    check(occupied(cloud.shuffled(seed).positions, lattice));
    // Two halves apart, and then their representatives.
    OccupiedCells all(1);
    const auto middle = cloud.positions.begin() + 1000;
    for (const std::vector<Eigen::Vector3d>& half :
         {std::vector(cloud.positions.begin(), middle), std::vector(middle, cloud.positions.end())}) {
      const OccupiedCells of_half = occupied(half, lattice);
      for (const Representative& r : of_half.representatives())
        all.add(lattice.place_of(r.point.position()), r);
    }
    check(all);
  }
}

TEST_CASE("cleared cells are empty") {
  const Lattice lattice(1);
  OccupiedCells cells = occupied({{0, 0, 0}, {5, 5, 5}}, lattice);
  cells.clear();
  CHECK(cells.representatives().empty());
  cells.add(lattice.place_of({5, 5, 5}), point_of({5, 5, 5}, 7));
  REQUIRE(cells.representatives().size() == 1);
  CHECK(value(cells.representatives()[0].point.id) == 7);
}

}  // namespace
}  // namespace lacuna
