// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/make_lid.hpp"

#include "engine/model/loop.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
using namespace io;
using namespace test;

namespace {

// ---- Loops drawn by hand, with the direction in which the surface around them lies

using Line = std::vector<Eigen::Vector3d>;

// A hole in the plane z = 0 around the polygon: the surface lies outside.
Loop hole_in_plane(const Line& polygon) {
  const std::size_t n = polygon.size();
  double area = 0;
  for (std::size_t i = 0; i < n; ++i)
    area += polygon[i].x() * polygon[(i + 1) % n].y() - polygon[i].y() * polygon[(i + 1) % n].x();
  Loop loop;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d along = polygon[(i + 1) % n] - polygon[(i + n - 1) % n];
    const Eigen::Vector3d out(along.y(), -along.x(), 0);
    loop.push_back(loop_point(i, polygon[i], ((area > 0 ? 1.0 : -1.0) * out).cast<float>()));
  }
  return loop;
}

// The corners, with so many points on each side.
Line with_points(const Line& corners, int points) {
  Line line;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d along = corners[(i + 1) % corners.size()] - corners[i];
    for (int k = 0; k < points; ++k) line.push_back(corners[i] + along * k / points);
  }
  return line;
}

// An L and a comb with three teeth: simple polygons that are not convex.
Line shape_of_l() {
  return {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};  // 6
}
Line comb() {
  return {{0, 0, 0}, {5, 0, 0}, {5, 4, 0}, {4, 4, 0}, {4, 1, 0}, {3, 1, 0},
          {3, 4, 0}, {2, 4, 0}, {2, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};  // 14
}
// By the formula of Gauss.
double plane_area(const Line& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return std::abs(twice) / 2;
}

// ---- Whether the triangles of a lid are a surface on its loops

// A lid is a sphere without so many discs, one for the loop and each island. Each of its edges on one
// triangle is between points of loops, and each such point has one that leaves it. All vertices are used.
bool is_surface_on_loops(const LidMesh& mesh, std::size_t loops) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  std::set<std::uint32_t> used;
  for (const LidTriangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      used.insert(triangle[i]);
      if (!directed.insert({triangle[i], triangle[(i + 1) % 3]}).second) return false;
    }
  }
  std::set<std::uint32_t> left;
  std::size_t edges = 0;
  for (const auto& [a, b] : directed) {
    const bool is_of_loop = directed.count({b, a}) == 0;
    if (is_of_loop && !left.insert(a).second) return false;
    // Points of one loop are in its order.
    if (is_of_loop && loops == 1 && b != (a + 1) % mesh.vertices.size()) return false;
    if (is_of_loop || a < b) ++edges;
  }
  const std::size_t vertices = mesh.vertices.size(), faces = mesh.triangles.size();
  return left.size() == mesh.vertices.size() && used.size() == vertices && *used.rbegin() + 1 == vertices &&
         vertices + faces + loops == edges + 2;
}

bool is_disc_on_loop(const LidMesh& mesh) {
  return is_surface_on_loops(mesh, 1);
}

// ---- Lids

constexpr double kPi = std::numbers::pi;

Lid made(const Loop& loop) {
  Lid lid = make_lid(loop);
  CHECK(lid.left_out == "");
  CHECK(is_disc_on_loop(lid.mesh));
  REQUIRE(lid.mesh.vertices.size() == loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) CHECK(lid.mesh.vertices[i] == loop[i].position());
  return lid;
}

TEST_CASE("the lid of a plane polygon lies in its plane and has exactly its area, convex or not") {
  Line star;
  for (int i = 0; i < 120; ++i) {
    const double turn = 2 * kPi * i / 120, r = i % 12 < 6 ? 1 + 0.1 * (i % 12) : 1.6 - 0.1 * (i % 12);
    star.emplace_back(r * std::cos(turn), r * std::sin(turn), 0);
  }
  for (const Line& polygon :
       {with_points({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}, 11), with_points(shape_of_l(), 9),
        with_points(comb(), 7), with_points(comb(), 60), star}) {
    Loop loop = hole_in_plane(polygon);
    for (const double side : {1.0, -1.0}) {  // in either direction
      const Lid lid = made(loop);
      CHECK(lid.area == Approx(plane_area(polygon)).epsilon(1e-11));
      for (const LidTriangle& triangle : lid.mesh.triangles) {
        CHECK(std::abs(lid.mesh.vertices[triangle[0]].z()) < 1e-12);
        CHECK(side * area_vector(lid.mesh, triangle).z() >= 0);  // all have the side of the loop
      }
      std::reverse(loop.begin(), loop.end());
    }
  }
}

TEST_CASE(
    "a lid leaves islands open: its area is the hole's without theirs, in whichever direction they run") {
  const auto square_at = [](double x, double y, double half, int on_side) {
    Line corners = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    for (Eigen::Vector3d& corner : corners) corner += Eigen::Vector3d(x, y, 0);
    return with_points(corners, on_side);
  };
  for (const int on_side : {4, 20, 90}) {
    const Loop hole = hole_in_plane(square_at(0, 0, 10, on_side));
    std::vector<Loop> islands;
    for (const auto& [x, y, half] : {std::array{-5.0, -4.0, 2.0}, {4.0, 5.0, 3.0}, {5.0, -6.0, 1.0}})
      islands.push_back(hole_in_plane(square_at(x, y, half, std::max(2, on_side / 4))));
    for (int turn = 0; turn < 2; ++turn) {
      const Lid lid = make_lid(hole, islands);
      INFO(on_side << " points on a side");
      REQUIRE(lid.left_out == "");
      CHECK(lid.area == Approx(400 - 16 - 36 - 4).epsilon(1e-9));
      CHECK(is_surface_on_loops(lid.mesh, 4));
      std::size_t at = hole.size();
      for (const Loop& island : islands)
        for (const LoopPoint& point : island) CHECK(lid.mesh.vertices[at++] == point.position());
      std::reverse(islands[turn].begin(), islands[turn].end());
    }
  }
  const std::vector<Loop> many(kMostIslands + 1, hole_in_plane(square_at(0, 0, 1, 1)));
  CHECK(make_lid(hole_in_plane(square_at(0, 0, 10, 4)), many).left_out == "more than 30 islands in it");
}

TEST_CASE("a loop that crosses itself has a lid that crosses itself, of the loop's points") {
  const Line bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const Line& line : {bow, with_points(bow, 10)}) CHECK(made(hole_in_plane(line)).area > 0);
}

TEST_CASE("islands that touch each other and their hole have a lid that is a surface, or a reason") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const auto square_at = [&](double x, double y, double half) {
      return hole_in_plane(with_points({{x - half, y - half, 0},
                                        {x + half, y - half, 0},
                                        {x + half, y + half, 0},
                                        {x - half, y + half, 0}},
                                       static_cast<int>(random.whole(1, 3))));
    };
    std::vector<Loop> islands;
    for (int i = 0; i < 4; ++i)
      islands.push_back(square_at(random.uniform(-1, 1), random.uniform(-1, 1), 0.5));
    const Lid lid = make_lid(square_at(0, 0, 1), islands);
    INFO("seed " << seed);
    CHECK(lid.mesh.triangles.empty() == !lid.left_out.empty());
    if (lid.left_out.empty()) CHECK(is_surface_on_loops(lid.mesh, 5));
  }
}

TEST_CASE("loops that are too short, too long or in one line have no lid, and the reason says so") {
  CHECK(make_lid({}).left_out == "fewer than 3 points");
  CHECK(make_lid(hole_in_plane({{0, 0, 0}, {1, 0, 0}})).left_out == "fewer than 3 points");
  CHECK(make_lid(hole_in_plane({{0, 0, 0}, {1, 1, 0}, {3, 3, 0}})).left_out == "all points in one line");
  CHECK(make_lid(hole_in_plane(Line(4, {7, 8, 9}))).left_out == "all points in one line");
  CHECK(make_lid(hole_in_plane(Line(kMostLoopPoints + 1, {7, 8, 9}))).left_out == "more than 5000 points");
}

TEST_CASE("any loop has a lid that is a disc") {
  const std::uint64_t loops = draws(40);
  for (std::uint64_t seed = 0; seed < loops; ++seed) {
    Random random(seed);
    const auto n = random.whole(3, 60);
    const double flatness = random.uniform(), steps = random.chance(0.3) ? 4 : 1e6;
    Loop loop;
    for (std::int64_t i = 0; i < n; ++i) {
      const double turn = 2 * kPi * static_cast<double>(i) / static_cast<double>(n);
      Eigen::Vector3d at(std::cos(turn), std::sin(turn), 0);
      at += flatness * Eigen::Vector3d(random.normal(), random.normal(), random.normal()) / 2;
      loop.push_back(loop_point(static_cast<std::uint64_t>(i), (at * steps).array().round() / steps,
                                random.direction().cast<float>()));
    }
    INFO("seed " << seed << ", " << n << " points");
    CHECK(std::isfinite(made(loop).area));
  }
}

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

TEST_CASE("of all triangulations of a polygon in space, the one of least area is found") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Line polygon = random_polygon(3 + static_cast<int>(seed % 7), seed);
    const LidMesh mesh = triangulate_polygon(polygon);
    CHECK(area(mesh) == Approx(least_area(polygon)).epsilon(1e-13));
    CHECK(is_disc_on_loop(mesh));
  }
}

TEST_CASE("a long polygon is triangulated in parts, without a new vertex and near the least area") {
  const Line polygon = with_points(comb(), 100);
  REQUIRE(polygon.size() == 1200);
  const LidMesh mesh = triangulate_polygon(polygon);
  CHECK(mesh.triangles.size() == 1198);
  CHECK(is_disc_on_loop(mesh));
  CHECK(area(mesh) == Approx(14).epsilon(1e-12));
}

}  // namespace
}  // namespace lacuna
