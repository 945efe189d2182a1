// SPDX-License-Identifier: Apache-2.0
#include "io/lids/refine.hpp"

#include "io/lids/relax_edges.hpp"
#include "io/lids/triangulate_polygon.hpp"
#include "tests/io/lids/drawn_loops.hpp"
#include "tests/io/lids/watertight.hpp"

#include <catch2/catch.hpp>

namespace lacuna {
using namespace io;

namespace {

LidMesh refined(const test::Line& polygon) {
  LidMesh mesh = triangulate_polygon(polygon);
  relax_edges(mesh);
  refine(mesh);
  return mesh;
}

}  // namespace

TEST_CASE("triangles of a refined lid are as large as the spacing of the loop demands") {
  const LidMesh mesh = refined(test::with_points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 20));
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

TEST_CASE("a lid that would have too many vertices is coarser, and covers its loop all the same") {
  const LidMesh mesh = refined(test::with_points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 300));
  const std::size_t inner = mesh.vertices.size() - mesh.loop_points;
  CHECK(inner <= kMostInnerVertices);
  CHECK(inner > kMostInnerVertices / 2);
  CHECK(test::is_disc_on_loop(mesh));
  CHECK(area(mesh) == Approx(1).epsilon(1e-12));
}

}  // namespace lacuna
