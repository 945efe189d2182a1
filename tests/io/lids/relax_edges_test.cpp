// SPDX-License-Identifier: Apache-2.0
#include "io/lids/relax_edges.hpp"

#include "io/lids/refine.hpp"
#include "io/lids/triangulate_polygon.hpp"
#include "tests/io/lids/drawn_loops.hpp"
#include "tests/io/lids/watertight.hpp"

namespace lacuna {
using namespace io;

namespace {

double angle(const LidMesh& mesh, const LidTriangle& triangle, std::size_t corner) {
  const Eigen::Vector3d& at = mesh.vertices[triangle[corner]];
  const Eigen::Vector3d a = mesh.vertices[triangle[(corner + 1) % 3]] - at;
  const Eigen::Vector3d b = mesh.vertices[triangle[(corner + 2) % 3]] - at;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double largest_sum_of_opposite_angles(const LidMesh& mesh) {
  const LidNeighbours across = neighbours(mesh);
  double largest = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t u = across[t][corner];
      if (u == kNoTriangle) continue;
      std::size_t opposite = 0;
      while (across[u][opposite] != t) ++opposite;
      largest = std::max(largest,
                         angle(mesh, mesh.triangles[t], corner) + angle(mesh, mesh.triangles[u], opposite));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("an edge stays where its swap would leave the polygon") {
  // The fourth corner of the arrowhead lies inside of the triangle of the others.
  LidMesh mesh{.vertices = {{0, 0, 0}, {4, 0, 0}, {1, 0.2, 0}, {0, 4, 0}},
               .loop_points = 4,
               .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const std::vector<LidTriangle> before = mesh.triangles;
  relax_edges(mesh);
  CHECK(mesh.triangles == before);
}

TEST_CASE("an edge stays where the new one exists already") {
  // A tetrahedron without its ground, and with its top far to one side: the longest edge from the top would
  // become one of the ground.
  LidMesh mesh{.vertices = {{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {-3, 0, 1}},
               .loop_points = 3,
               .triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  relax_edges(mesh);
  CHECK(test::is_disc_on_loop(mesh));
}

TEST_CASE("in a plane, the result is Delaunay and as large as before, without a flat triangle") {
  for (const test::Line& corners : {test::shape_of_l(), test::comb()}) {
    LidMesh mesh = triangulate_polygon(test::with_points(corners, 12));
    const double before = area(mesh);
    relax_edges(mesh);
    CHECK(test::is_disc_on_loop(mesh));
    CHECK(area(mesh) == Approx(before).epsilon(1e-13));
    CHECK(largest_sum_of_opposite_angles(mesh) < M_PI + 1e-6);
    for (const LidTriangle& triangle : mesh.triangles) CHECK(area_vector(mesh, triangle).z() > 1e-6);
  }
}

TEST_CASE("triangles of a refined lid are as large as the spacing of the loop demands") {
  LidMesh mesh = triangulate_polygon(test::with_points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 20));
  relax_edges(mesh);
  refine(mesh);
  CHECK(test::is_disc_on_loop(mesh));
  CHECK(area(mesh) == Approx(1).epsilon(1e-13));
  double sum = 0, longest = 0;
  for (const LidTriangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double length = (mesh.vertices[triangle[i]] - mesh.vertices[triangle[(i + 1) % 3]]).norm();
      sum += length / static_cast<double>(3 * mesh.triangles.size());
      longest = std::max(longest, length);
    }
  }
  constexpr double kSpacing = 0.05;
  CHECK(sum == Approx(kSpacing).epsilon(0.15));
  CHECK(longest < 2 * kSpacing);
}

}  // namespace lacuna
