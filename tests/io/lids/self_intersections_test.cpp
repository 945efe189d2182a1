// SPDX-License-Identifier: Apache-2.0
#include "io/lids/self_intersections.hpp"

#include "tests/io/lids/drawn_loops.hpp"

namespace lacuna {
using namespace io;
using test::Line;

namespace {

// Two triangles without a common vertex.
LidMesh two(const Line& vertices) {
  return {.vertices = vertices, .loop_points = 6, .triangles = {{0, 1, 2}, {3, 4, 5}}};
}

const Line kFlat = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};

Line with(const Line& other) {
  Line both = kFlat;
  both.insert(both.end(), other.begin(), other.end());
  return both;
}

}  // namespace

TEST_CASE("triangles intersect where an edge of one passes through the other") {
  CHECK(has_intersections(two(with({{0.5, 0.5, -1}, {0.5, 0.5, 1}, {5, 5, 0.5}}))));
  CHECK(has_intersections(two(with({{-1, 0.5, -1}, {-1, 0.5, 1}, {5, 0.5, 0.1}}))));
  CHECK_FALSE(has_intersections(two(with({{0.5, 0.5, 0.1}, {0.5, 0.5, 1}, {5, 5, 0.5}}))));
  CHECK_FALSE(has_intersections(two(with({{3, 3, -1}, {3, 3, 1}, {5, 5, 0.5}}))));
}

TEST_CASE("triangles in one plane intersect where they overlap, not where they touch") {
  CHECK(has_intersections(two(with({{0.5, 0.5, 0}, {3, 0.5, 0}, {3, 3, 0}}))));
  CHECK(has_intersections(two(with({{0.2, 0.2, 0}, {0.4, 0.2, 0}, {0.2, 0.4, 0}}))));  // inside
  CHECK_FALSE(has_intersections(two(with({{2, 0, 0}, {3, 0, 0}, {2, 3, 0}}))));
  CHECK_FALSE(has_intersections(two(with({{3, 0, 0}, {4, 0, 0}, {3, 3, 0}}))));
}

TEST_CASE("triangles on one edge intersect where they are folded onto each other") {
  LidMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
               .loop_points = 4,
               .triangles = {{0, 1, 2}, {0, 2, 3}}};
  CHECK_FALSE(has_intersections(mesh));
  mesh.vertices[3] = {1, 0.2, 0};
  CHECK(has_intersections(mesh));
}

TEST_CASE("a loop crosses itself where two of its edges do, seen along its normal") {
  CHECK_FALSE(crosses_itself(test::with_points(test::comb(), 5)));
  CHECK_FALSE(crosses_itself(kFlat));
  // An eight of two unlike halves, whose crossing is a bridge in space.
  const Line eight = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0.1}, {-1, 3, 0.1}};
  CHECK(crosses_itself(eight));
  CHECK(crosses_itself(Line{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}));  // has no normal
}

}  // namespace lacuna
