// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/make_lid.hpp"
#include "tests/io/lids/drawn_loops.hpp"
#include "tests/io/lids/watertight.hpp"
#include "tests/support/clouds.hpp"

namespace lacuna {
using namespace io;
using test::Line;

namespace {

Line random_polygon(int points, std::uint64_t seed) {
  Random random(seed);
  Line polygon;
  for (int i = 0; i < points; ++i) polygon.emplace_back(random.uniform(), random.uniform(), random.uniform());
  return polygon;
}

// Tries all triangulations: every apex on the first edge, and what it leaves on both sides.
double least_area(const Line& polygon) {
  if (polygon.size() < 3) return 0;
  double least = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d &first = polygon.front(), &last = polygon.back();
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const double at_edge = (polygon[k] - first).cross(last - first).norm() / 2;
    const auto apex = polygon.begin() + static_cast<std::ptrdiff_t>(k);
    least = std::min(least,
                     at_edge + least_area({polygon.begin(), apex + 1}) + least_area({apex, polygon.end()}));
  }
  return least;
}

}  // namespace

TEST_CASE("of all triangulations of a polygon in space, that of least area is found") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Line polygon = random_polygon(3 + static_cast<int>(seed % 7), seed);
    const LidMesh mesh = triangulate_polygon(polygon);
    CHECK(area(mesh) == Approx(least_area(polygon)).epsilon(1e-13));
    CHECK(test::is_disc_on_loop(mesh));
  }
}

TEST_CASE("a long polygon is triangulated in parts, without a new vertex and near the least area") {
  const Line polygon = test::with_points(test::comb(), 100);
  REQUIRE(polygon.size() == 1200);
  const LidMesh mesh = triangulate_polygon(polygon);
  CHECK(mesh.triangles.size() == 1198);
  CHECK(test::is_disc_on_loop(mesh));
  CHECK(area(mesh) == Approx(14).epsilon(1e-12));
}

}  // namespace lacuna
