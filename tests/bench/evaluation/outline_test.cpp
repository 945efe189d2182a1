// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/outline.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna::evaluation {
namespace {

using Polygon = std::vector<Eigen::Vector3d>;

// How often the polygon, in the plane z = 0, winds around the place.
bool is_wound_around(const Polygon& polygon, const Eigen::Vector3d& place) {
  double turn = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d a = polygon[i] - place, b = polygon[(i + 1) % polygon.size()] - place;
    turn += std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
  }
  return std::abs(turn) > std::numbers::pi;
}

}  // namespace

TEST_CASE("an outline contains what a star-shaped polygon winds around, in any position") {
  Random random(7);
  for (const int corners : {3, 4, 50, 1000}) {
    Polygon star;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, radius = random.uniform(2, 10);
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), random.direction());
    const Eigen::Vector3d move(1e5, -1e5, 10);
    Polygon moved;
    for (const Eigen::Vector3d& corner : star) moved.push_back(turn * corner + move);
    const Outline outline(moved);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d place(random.uniform(-11, 11), random.uniform(-11, 11), 0);
      CHECK(outline.contains(turn * place + move) == is_wound_around(star, place));
    }
  }
}

TEST_CASE("what has no area contains nothing") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Polygon& polygon :
       {Polygon{}, Polygon{{1, 1, 1}}, Polygon{{0, 0, 0}, {4, 0, 0}},
        Polygon{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}, Polygon{{0, 0, 0}, {4, 0, 0}, {0, nan, 0}}}) {
    const Outline outline(polygon);
    CHECK_FALSE(outline.contains({0, 0, 0}));
    CHECK_FALSE(outline.contains({1, 0.5, 0}));
  }
  const Outline triangle(Polygon{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  CHECK_FALSE(triangle.contains({nan, 1, 1}));
  CHECK_FALSE(triangle.contains({1, 1e300, 1}));
  CHECK_FALSE(triangle.contains({-1e300, 1, 1}));
}

}  // namespace lacuna::evaluation
