// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/scan_axes.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

constexpr double kStep = 0.2;

struct Drawn {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;

  // A rectangle with edges along two axes, from its least corner.
  Drawn& add(const Eigen::Vector3d& corner, const Eigen::Vector3d& sizes) {
    int flat = 0;
    sizes.minCoeff(&flat);
    const int u = (flat + 1) % 3, v = (flat + 2) % 3;
    for (double a = 0; a < sizes[u]; a += kStep) {
      for (double b = 0; b < sizes[v]; b += kStep) {
        Eigen::Vector3d at = corner;
        at[u] += a;
        at[v] += b;
        points.push_back(at);
        normals.push_back(Eigen::Vector3f::Unit(flat));
      }
    }
    return *this;
  }

  std::optional<Upward> turned(const Eigen::Quaterniond& turn) const {
    Drawn other = *this;
    for (Eigen::Vector3d& point : other.points) point = turn * point + Eigen::Vector3d(5e5, 5e6, 100);
    for (Eigen::Vector3f& normal : other.normals) normal = turn.cast<float>() * normal;
    return other_upward(other.points, other.normals, static_cast<double>(points.size()) * kStep * kStep);
  }
  // Turns the scene so that its z becomes this direction.
  std::optional<Upward> with_up(const Eigen::Vector3d& up) const {
    return turned(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up));
  }
};

// A level ground with walls on it.
Drawn yard() {
  Drawn scene;
  scene.add({0, 0, 0}, {24, 24, 0});
  for (int i = 0; i < 6; ++i) {
    scene.add({4.0 * i, 3 + std::fmod(7.3 * i, 16), 0}, {3, 0, 2});
    scene.add({2 + std::fmod(5.1 * i, 18), 4.0 * i, 0}, {0, 3, 2});
  }
  return scene;
}

Drawn room() {
  Drawn scene;
  for (const double side : {0.0, 1.0})
    scene.add({0, 0, 2.6 * side}, {8, 6, 0})
        .add({0, 6 * side, 0}, {8, 0, 2.6})
        .add({8 * side, 0, 0}, {0, 6, 2.6});
  return scene;
}

}  // namespace

TEST_CASE("what is up is found in all three axes and both senses, and z upwards is no finding") {
  const Drawn scene = yard();
  CHECK_FALSE(scene.with_up({0, 0, 1}));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sense : {1.0, -1.0}) {
      if (axis == 2 && sense > 0) continue;
      INFO(axis << " " << sense);
      const auto found = scene.with_up(sense * Eigen::Vector3d::Unit(axis));
      REQUIRE(found);
      CHECK(found->axis == axis);
      CHECK(found->is_known);
      CHECK(found->is_down == (sense < 0));
      CHECK(found->level[static_cast<std::size_t>(axis)] > 14'000);
    }
  }
}

TEST_CASE("below a ceiling, things hide the floor: what has fewer level ends is down") {
  Drawn hall;
  hall.add({0, 0, 6}, {24, 24, 0}).add({0, 0, 0}, {24, 18, 0});
  for (int i = 0; i < 15; ++i) hall.add({0, 18 + 2 * kStep * i, 0.5}, {24, 0, 2});  // shelves from the side
  CHECK_FALSE(hall.with_up({0, 0, 1}));
  const auto found = hall.with_up({0, 0, -1});
  REQUIRE(found);
  CHECK((found->axis == 2 && found->is_down));
}

TEST_CASE("a room on its side shows which axis is vertical, but not which end is up") {
  CHECK_FALSE(room().with_up({0, 0, 1}));
  CHECK_FALSE(room().with_up({0, 0, -1}));  // it looks alike
  const auto found = room().with_up({0, 1, 0});
  REQUIRE(found);
  CHECK(found->axis == 1);
  CHECK_FALSE(found->is_known);
}

TEST_CASE("walls with more points than the ground, and a corridor of walls alone, are no finding") {
  CHECK_FALSE(Drawn().add({0, 0, 0}, {30, 0, 20}).add({0, 0, 0}, {30, 4, 0}).with_up({0, 0, 1}));
  CHECK_FALSE(Drawn().add({0, 0, 0}, {30, 0, 6}).add({0, 4, 0}, {30, 0, 6}).with_up({0, 0, 1}));
  CHECK_FALSE(Drawn().with_up({0, 0, 1}));
}

}  // namespace lacuna::io
