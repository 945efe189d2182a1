// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/make_lid.hpp"

#include "tests/io/lids/drawn_loops.hpp"
#include "tests/io/lids/watertight.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/loop_points.hpp"

namespace lacuna {
using namespace io;
using test::hole_in_plane;
using test::hole_in_sphere;
using test::is_disc_on_loop;
using test::Line;
using test::with_points;

namespace {

constexpr double kPi = std::numbers::pi;

// A hole without symmetry, in a surface that is not plane.
Loop wavy_hole(int points) {
  Random random(7);
  Loop loop;
  double turn = 0;
  for (int i = 0; i < points; ++i) {
    turn += 2 * kPi / points * random.uniform(0.7, 1.3);
    const double r = 1 + 0.3 * std::sin(3 * turn + 1) + 0.02 * random.uniform();
    const Eigen::Vector3d surface(std::cos(turn), std::sin(turn), 0.4 * std::sin(turn));
    loop.push_back(test::loop_point(static_cast<std::uint64_t>(i),
                                    {r * std::cos(turn), r * std::sin(turn), 0.3 * std::sin(2 * turn)},
                                    surface.cast<float>()));
  }
  return loop;
}

Lid made(const Loop& loop) {
  Lid lid = make_lid(loop);
  CHECK(lid.left_out == "");
  CHECK(is_disc_on_loop(lid.mesh));
  REQUIRE(lid.mesh.vertices.size() == loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) CHECK(lid.mesh.vertices[i] == loop[i].position());
  return lid;
}

}  // namespace

TEST_CASE("the lid of a plane polygon lies in its plane and has exactly its area, convex or not") {
  Line star;
  for (int i = 0; i < 120; ++i) {
    const double turn = 2 * kPi * i / 120, r = i % 12 < 6 ? 1 + 0.1 * (i % 12) : 1.6 - 0.1 * (i % 12);
    star.emplace_back(r * std::cos(turn), r * std::sin(turn), 0);
  }
  for (const Line& polygon :
       {with_points({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}, 11), with_points(test::shape_of_l(), 9),
        with_points(test::comb(), 7), with_points(test::comb(), 60), star}) {
    const Lid lid = made(hole_in_plane(polygon));
    CHECK(lid.area == Approx(test::plane_area(polygon)).epsilon(1e-11));
    double off = 0, turned = 0;
    for (const Eigen::Vector3d& vertex : lid.mesh.vertices) off = std::max(off, std::abs(vertex.z()));
    for (const LidTriangle& triangle : lid.mesh.triangles)
      turned = std::min(turned, area_vector(lid.mesh, triangle).z());
    CHECK(off < 1e-12);
    CHECK(turned >= 0);  // all have the side of the loop
  }
}

TEST_CASE("a lid has the side of its loop, in either direction") {
  Loop loop = hole_in_sphere(0.6, 50);
  for (const double side : {1.0, -1.0}) {
    const Lid lid = made(loop);
    Eigen::Vector3d sum(0, 0, 0);
    for (const LidTriangle& triangle : lid.mesh.triangles) sum += area_vector(lid.mesh, triangle);
    CHECK(side * sum.z() > 0);
    std::reverse(loop.begin(), loop.end());
  }
}

TEST_CASE("a turn, a place as of UTM and another first point do not change the area of a lid") {
  const Loop loop = wavy_hole(158);
  const double area = made(loop).area;
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  CHECK(made(test::moved(loop, Eigen::Isometry3d(turn))).area == Approx(area).epsilon(1e-8));
  // There, coordinates are rounded to 1e-9.
  const Eigen::Isometry3d to_utm(Eigen::Translation3d(500'000.3, 5'400'000.7, 312.9));
  CHECK(made(test::moved(loop, to_utm)).area == Approx(area).epsilon(1e-7));
  Loop rotated = loop;
  std::rotate(rotated.begin(), rotated.begin() + 41, rotated.end());
  CHECK(made(rotated).area == Approx(area).epsilon(1e-11));
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
      CHECK(test::is_surface_on_loops(lid.mesh, 4));
      std::size_t at = hole.size();
      for (const Loop& island : islands)
        for (const LoopPoint& point : island) CHECK(lid.mesh.vertices[at++] == point.position());
      std::reverse(islands[turn].begin(), islands[turn].end());
    }
  }
  const std::vector<Loop> many(kMostIslands + 1, hole_in_plane(square_at(0, 0, 1, 1)));
  CHECK(make_lid(hole_in_plane(square_at(0, 0, 10, 4)), many).left_out == "more than 30 islands in it");
}

TEST_CASE("equal loops have equal lids, to the last bit") {
  const Lid a = make_lid(wavy_hole(300)), b = make_lid(wavy_hole(300));
  CHECK(a.mesh.vertices == b.mesh.vertices);
  CHECK(a.mesh.triangles == b.mesh.triangles);
  CHECK(a.area == b.area);
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
    if (lid.left_out.empty()) CHECK(test::is_surface_on_loops(lid.mesh, 5));
  }
}

TEST_CASE("loops that are too short, too long or in one line have no lid, and the reason says so") {
  CHECK(make_lid({}).left_out == "fewer than 3 points");
  CHECK(make_lid(hole_in_plane({{0, 0, 0}, {1, 0, 0}})).left_out == "fewer than 3 points");
  CHECK(make_lid(hole_in_plane({{0, 0, 0}, {1, 1, 0}, {3, 3, 0}})).left_out == "all points in one line");
  CHECK(make_lid(hole_in_plane(Line(4, {7, 8, 9}))).left_out == "all points in one line");
  CHECK(make_lid(hole_in_sphere(1, kMostLoopPoints + 1)).left_out == "more than 5000 points");
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
      loop.push_back(test::loop_point(static_cast<std::uint64_t>(i), (at * steps).array().round() / steps,
                                      random.direction().cast<float>()));
    }
    INFO("seed " << seed << ", " << n << " points");
    CHECK(std::isfinite(made(loop).area));
  }
}

}  // namespace lacuna
