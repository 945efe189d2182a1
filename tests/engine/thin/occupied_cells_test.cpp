#include "engine/thin/occupied_cells.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

// Both passes over the cloud.
OccupiedCells occupied(const Cloud& cloud, const Lattice& lattice) {
  OccupiedCells cells({}, 1 << 20);
  for (const Eigen::Vector3d& p : cloud.positions) REQUIRE(cells.add(lattice.place_of(p)));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const LatticePlace place = lattice.place_of(cloud.positions[i]);
    offer(*cells.find(place), place, cloud.positions[i], Eigen::Vector3d::Zero(), PointId{i});
  }
  return cells;
}

Cloud cloud_of(std::vector<Eigen::Vector3d> positions) {
  return {std::move(positions), {}};
}

TEST_CASE("cells of the lattice are counted from the origin of the coordinates") {
  const Lattice lattice(0.5);
  CHECK(lattice.place_of({0.1, 0.5, 1.7}).cell == Eigen::Vector3d(0, 1, 3));
  CHECK(lattice.place_of({-0.1, -0.5, -0.6}).cell == Eigen::Vector3d(-1, -1, -2));
  CHECK(lattice.place_of({500'000.3, 5'400'000.1, 0}).cell == Eigen::Vector3d(1'000'000, 10'800'000, 0));
  CHECK(lattice.place_of({0.25, 0, -1e-300}).offset ==
        std::array<std::uint32_t, 3>{1u << 31, 0, 0xffffffffu});
  CHECK(lattice.place_of({-0.0, 0, 0}).hash == lattice.place_of({0, 0, 0}).hash);
  CHECK_FALSE(Lattice(1e-100).place_of({1e300, 0, 0}).cell.allFinite());
}

TEST_CASE(
    "the point nearest to the mean represents its cell, of several the one with the lowest coordinates, then "
    "id") {
  const Lattice lattice(10);
  const auto representative = [&](const Cloud& cloud) {
    const OccupiedCells cells = occupied(cloud, lattice);
    REQUIRE(cells.size() == 1);
    return value(cells.all().front().id);
  };
  CHECK(representative(cloud_of({{1, 1, 1}})) == 0);
  CHECK(representative(cloud_of({{1, 5, 5}, {2, 5, 5}, {9, 5, 5}})) == 1);  // mean 4
  CHECK(representative(cloud_of({{4, 5, 5}, {6, 5, 5}})) == 0);             // a tie
  CHECK(representative(cloud_of({{9, 5, 5}, {6, 5, 5}, {4, 5, 5}, {1, 5, 5}})) == 2);
  CHECK(representative(cloud_of({{-1, -5, -5}, {-2, -5, -5}, {-9, -5, -5}})) == 1);
}

TEST_CASE("the representatives of random points are the nearest to the means, in any order of the points") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    const Cloud cloud = scattered(2000, seed).noisy(0.1, seed).translated({1e5, -3e5, 7});
    const double edge = 0.13;
    const Lattice lattice(edge);
    std::map<std::array<double, 3>, std::vector<std::size_t>> plain;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d cell = lattice.place_of(cloud.positions[i]).cell;
      CHECK(((cell * edge - cloud.positions[i]).array() <= 1e-9).all());
      CHECK(((cell * edge + Eigen::Vector3d::Constant(edge) - cloud.positions[i]).array() >= -1e-9).all());
      plain[{cell.x(), cell.y(), cell.z()}].push_back(i);
    }
    const OccupiedCells cells = occupied(cloud, lattice);
    REQUIRE(cells.size() == plain.size());
    for (const OccupiedCell& cell : cells.all()) {
      const std::vector<std::size_t>& members = plain.at({cell.cell.x(), cell.cell.y(), cell.cell.z()});
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const std::size_t i : members) mean += cloud.positions[i] / static_cast<double>(members.size());
      double nearest = std::numeric_limits<double>::infinity();
      for (const std::size_t i : members) nearest = std::min(nearest, (cloud.positions[i] - mean).norm());
      CHECK(cell.points == members.size());
      CHECK(cell.nearest == cloud.positions[value(cell.id)]);
      CHECK((cell.nearest - mean).norm() <= nearest + 1e-9);
    }
    // The positions are the same in any order.
    OccupiedCells shuffled = occupied(cloud.shuffled(seed), lattice);
    for (const OccupiedCell& cell : cells.all()) {
      const OccupiedCell* const other = shuffled.find(lattice.place_of(cell.nearest));
      REQUIRE(other != nullptr);
      CHECK(other->nearest == cell.nearest);
    }
  }
}

TEST_CASE("where memory ends, half of the cells are left, and both halves are all") {
  const Lattice lattice(0.01);
  const Cloud cloud = scattered(5000, 1);
  std::size_t all = 0;
  std::vector<CellShare> shares = {{}};
  std::size_t rounds = 0;
  for (; !shares.empty(); ++rounds) {
    OccupiedCells cells(shares.back(), 100'000);
    shares.pop_back();
    for (const Eigen::Vector3d& p : cloud.positions) {
      const LatticePlace place = lattice.place_of(p);
      while (cells.share().contains(place.hash) && !cells.add(place)) {
        shares.push_back(cells.share().half(true));
        cells.halve();
      }
    }
    for (const OccupiedCell& cell : cells.all()) CHECK(cells.share().contains(hash_of(cell.cell)));
    for (const OccupiedCell& cell : cells.all()) all += cell.points;
  }
  CHECK(all == cloud.size());
  CHECK(rounds > 4);
}

}  // namespace
}  // namespace lacuna
