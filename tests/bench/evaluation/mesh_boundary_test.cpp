// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loops_reader.hpp"
#include "tests/support/clouds.hpp"
#include "tests/tools/matching/drawn.hpp"

namespace lacuna::evaluation {
namespace {

using Ids = std::vector<std::uint64_t>;

// A disc of n triangles around its centre. With `torn`, every triangle brings points of its own, so that the
// disc hangs together by coordinates only. Returns the ids of its edge.
Ids add_disc(Drawing& drawing, std::vector<Triangle>& triangles, std::uint64_t n, double x, bool torn) {
  const LoopIds rim = drawing.ring(n, x, 0);
  const std::uint64_t centre = drawing.point(x, -0.0);
  for (std::uint64_t i = 0; i < n; ++i) {
    Triangle triangle = {centre, rim[i], rim[(i + 1) % n]};
    if (torn) {
      for (std::uint64_t& corner : triangle) {
        const Eigen::Vector3d p = drawing.positions[corner];
        corner = drawing.point(p.x(), p.y() + 0.0, p.z());
      }
    }
    triangles.push_back(triangle);
  }
  return rim;
}

// 5 x 5 squares of points a unit apart, without some of them. Ids are those of plane(6), though the mesh has
// the points in the order of `ids`.
std::vector<TrueLoop> sheet_without(const std::vector<std::array<std::uint64_t, 2>>& missing,
                                    const Ids& ids) {
  std::vector<Eigen::Vector3d> positions;
  Ids place(36);
  for (const std::uint64_t id : ids) {
    place[id] = positions.size();
    positions.push_back(plane(6).positions[id]);
  }
  std::vector<Triangle> triangles;
  for (std::uint64_t y = 0; y < 5; ++y) {
    for (std::uint64_t x = 0; x < 5; ++x) {
      if (std::find(missing.begin(), missing.end(), std::array{x, y}) != missing.end()) continue;
      const std::uint64_t a = 6 * y + x;
      triangles.push_back({place[a], place[a + 1], place[a + 7]});
      triangles.push_back({place[a], place[a + 7], place[a + 6]});
    }
  }
  auto loops = mesh_boundary(triangles, stand_ins(positions), positions);
  for (TrueLoop& loop : loops) {
    for (std::uint64_t& vertex : loop.vertices) vertex = ids[vertex];
    std::sort(loop.vertices.begin(), loop.vertices.end());
  }
  std::sort(loops.begin(), loops.end(),
            [](const TrueLoop& one, const TrueLoop& other) { return one.vertices < other.vertices; });
  return loops;
}

// In another order each time.
Ids shuffled_ids(std::uint64_t seed) {
  Random random(seed);
  Ids ids(36);
  std::iota(ids.begin(), ids.end(), 0u);
  for (std::int64_t i = 35; i > 0; --i) std::swap(ids[i], ids[random.whole(0, i)]);
  return ids;
}

}  // namespace

TEST_CASE("the boundary of two discs is two loops, also where their triangles share no vertex") {
  for (const bool torn : {false, true}) {
    Drawing drawing;
    std::vector<Triangle> triangles;
    const Ids first = add_disc(drawing, triangles, 12, 0, torn);
    const Ids second = add_disc(drawing, triangles, 20, 50, torn);
    const auto loops = mesh_boundary(triangles, stand_ins(drawing.positions), drawing.positions);
    REQUIRE(loops.size() == 2);
    CHECK(loops[0].vertices == first);
    CHECK(loops[0].edges.size() == 12);
    CHECK(loops[1].vertices == second);
    CHECK(loops[1].edges.size() == 20);
    for (const TrueLoop& loop : loops) {
      for (std::size_t i = 0; i < loop.edges.size(); ++i)
        CHECK(loop.edges[i][1] == loop.edges[(i + 1) % loop.edges.size()][0]);
    }
  }
}

TEST_CASE("holes that touch at several vertices stay apart, whatever lies between them") {
  // The square in the middle hangs at its four corners.
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto loops = sheet_without({{1, 2}, {3, 2}, {2, 1}, {2, 3}}, shuffled_ids(seed));
    REQUIRE(loops.size() == 5);
    CHECK(loops[1].vertices == Ids{8, 9, 14, 15});
    CHECK(loops[2].vertices == Ids{13, 14, 19, 20});
    CHECK(loops[3].vertices == Ids{15, 16, 21, 22});
    CHECK(loops[4].vertices == Ids{20, 21, 26, 27});
  }
}

TEST_CASE("the order of triangles and of their corners does not change loops") {
  Random random(5);
  std::vector<Triangle> triangles;
  std::vector<Eigen::Vector3d> positions = plane(12).positions;
  for (std::uint64_t y = 0; y < 11; ++y) {
    for (std::uint64_t x = 0; x < 11; ++x) {
      if (random.chance(0.3)) continue;
      const std::uint64_t a = 12 * y + x;
      triangles.push_back({a, a + 1, a + 13});
      triangles.push_back({a, a + 13, a + 12});
    }
  }
  const auto expected = mesh_boundary(triangles, stand_ins(positions), positions);
  std::size_t edges = 0;
  for (const TrueLoop& loop : expected) {
    CHECK(loop.vertices.size() == loop.edges.size());
    CHECK(std::adjacent_find(loop.vertices.begin(), loop.vertices.end()) == loop.vertices.end());
    edges += loop.edges.size();
  }
  for (int turn = 0; turn < 3; ++turn) {
    std::reverse(triangles.begin(), triangles.end());
    for (Triangle& triangle : triangles) std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
    // The last time every triangle is seen from its other side.
    for (Triangle& triangle : triangles)
      if (turn == 2) std::swap(triangle[0], triangle[1]);
    const auto loops = mesh_boundary(triangles, stand_ins(positions), positions);
    REQUIRE(loops.size() == expected.size());
    std::size_t again = 0;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      CHECK(loops[i].vertices == expected[i].vertices);
      again += loops[i].edges.size();
    }
    CHECK(again == edges);
  }
}

TEST_CASE("a closed mesh, triangles without area and no triangles have no boundary") {
  Drawing drawing;
  for (int i = 0; i < 4; ++i) drawing.point(i == 1, i == 2, i == 3);
  const std::vector<Triangle> closed = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  CHECK(mesh_boundary(closed, stand_ins(drawing.positions), drawing.positions).empty());
  drawing.point(1, 0);  // at the place of 1
  const std::vector<Triangle> flat = {{0, 1, 4}};
  CHECK(mesh_boundary(flat, stand_ins(drawing.positions), drawing.positions).empty());
  CHECK(mesh_boundary({}, {}, {}).empty());
}

}  // namespace lacuna::evaluation
