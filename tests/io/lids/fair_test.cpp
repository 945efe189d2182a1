// SPDX-License-Identifier: Apache-2.0
#include "io/lids/fair.hpp"

#include "io/lids/refine.hpp"
#include "io/lids/relax_edges.hpp"
#include "io/lids/triangulate_polygon.hpp"
#include "tests/io/lids/drawn_loops.hpp"

#include <limits>

#include <catch2/catch.hpp>

namespace lacuna {
using namespace io;

namespace {

LidMesh unfaired(const Loop& loop) {
  LidMesh mesh = triangulate_polygon(test::line_of(loop));
  relax_edges(mesh);
  refine(mesh);
  return mesh;
}

test::Line surface_of(const Loop& loop) {
  test::Line surface;
  for (const LoopPoint& point : loop) surface.push_back(point.surface.cast<double>());
  return surface;
}

double largest_move(const LidMesh& a, const LidMesh& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    largest = std::max(largest, (a.vertices[i] - b.vertices[i]).norm());
  return largest;
}

double height(const LidMesh& mesh) {
  double height = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& vertex : mesh.vertices) height = std::max(height, vertex.z());
  return height;
}

}  // namespace

TEST_CASE("in a plane, neither thin plate nor membrane moves a vertex") {
  const Loop loop = test::hole_in_plane(test::with_points(test::shape_of_l(), 12));
  const LidMesh before = unfaired(loop);
  LidMesh plate = before, membrane = before;
  CHECK(fair(plate, surface_of(loop)) == Fairing::kThinPlate);
  fair_membrane(membrane);
  CHECK(largest_move(plate, before) < 1e-9);
  CHECK(largest_move(membrane, before) < 1e-9);
}

TEST_CASE("the thin plate rises from the loop as the surface does, the membrane does not") {
  constexpr double kHalfAngle = 0.5;
  const Loop loop = test::hole_in_sphere(kHalfAngle, 100);
  LidMesh plate = unfaired(loop), membrane = plate;
  CHECK(fair(plate, surface_of(loop)) == Fairing::kThinPlate);
  fair_membrane(membrane);
  CHECK(height(plate) == Approx(1).margin(0.01));  // of the sphere
  CHECK(height(membrane) == Approx(std::cos(kHalfAngle)));
  for (std::size_t i = 0; i < loop.size(); ++i) CHECK(plate.vertices[i] == loop[i].position);
}

TEST_CASE("where the direction of the surface is not known, the lid is the membrane's") {
  const Loop loop = test::hole_in_sphere(0.5, 100);
  LidMesh lid = unfaired(loop), membrane = lid;
  fair_membrane(membrane);
  for (const double unknown : {0.0, std::numeric_limits<double>::infinity()}) {
    LidMesh flat = lid;
    fair(flat, test::Line(loop.size(), Eigen::Vector3d::Constant(unknown)));
    CHECK(largest_move(flat, membrane) < 1e-6);
  }
}

TEST_CASE("a surface that ends in an edge at the loop does not bend the lid") {
  const Loop loop = test::hole_in_sphere(M_PI / 2, 100);  // the surface is perpendicular to the lid
  LidMesh lid = unfaired(loop);
  fair(lid, surface_of(loop));
  CHECK(height(lid) < 1e-9);
}

}  // namespace lacuna
