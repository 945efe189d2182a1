// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/point_rules.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> heights;
  for (int i = 0; i < count; ++i) heights.push_back(from + (to - from) * i / (count - 1));
  return heights;
}

std::vector<double> joined(std::vector<double> heights, const std::vector<double>& more) {
  heights.insert(heights.end(), more.begin(), more.end());
  return heights;
}

// The number of heights that lie apart.
std::uint64_t apart(std::vector<double> heights) {
  std::mt19937 random(1);
  HeightGroups groups(100);
  std::ranges::shuffle(heights, random);
  for (const double height : heights) groups.add(height);
  std::uint64_t count = 0;
  for (const HeightGroup& group : groups.parts().apart) count += group.points;
  return count;
}

TEST_CASE("no-data values, clouds and stray returns lie apart from the ground", "[io][area]") {
  const std::vector<double> ground = evenly(300, 360, 1000);
  for (const double value : {-9999., -32768., -3.4028234663852886e38, 99999., 1e30, 0., -1.}) {
    CHECK(apart(joined(ground, std::vector<double>(40, value))) == 40);
    CHECK(apart(joined(ground, std::vector<double>(4000, value))) == 4000);  // more than the ground has
  }
  CHECK(apart(joined(ground, evenly(1480, 1520, 40))) == 40);
  CHECK(apart(joined(joined(ground, evenly(-400, 100, 20)), {900})) == 21);
  CHECK(apart(joined(std::vector<double>(1000, 12), evenly(1480, 1520, 40))) == 40);  // water alone
  CHECK(apart(joined(evenly(-900, 900, 3000), std::vector<double>(9, -9999))) == 9);
}

TEST_CASE("steep ground, trees, towers, bridges and two terraces are ground", "[io][area]") {
  const std::vector<double> ground = evenly(0, 5, 1000);
  CHECK(apart({}) == 0);
  CHECK(apart({7}) == 0);
  CHECK(apart(evenly(0, 3000, 1000)) == 0);
  CHECK(apart(joined(ground, evenly(20, 45, 30))) == 0);
  CHECK(apart(joined(ground, std::vector<double>(30, 90))) == 0);
  CHECK(apart(joined(ground, evenly(0, 340, 10))) == 0);
  CHECK(apart(joined(ground, evenly(800, 810, 400))) == 0);
}

TEST_CASE("a point that two files round differently is one, and near points of other times are not",
          "[io][area]") {
  constexpr double kStep = 0.01;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 50);
  RepeatedPoints repeated({.with_time = 1.1 * kStep, .without_time = 1.1 * kStep}, 1 << 20);
  constexpr int kPoints = 2500;
  int again = 0;
  for (int i = 0; i < 2 * kPoints; ++i) {
    const Eigen::Vector3d at(place(random), place(random), place(random));
    const double time = i % 2 * (1 + i);  // half have none
    const Eigen::Vector3d first = (at.array() / kStep).round() * kStep;
    const Eigen::Vector3d second = ((at.array() - kStep / 2) / kStep).round() * kStep + kStep / 2;
    CHECK_FALSE(repeated.add(first, time));
    CHECK(repeated.add(first, time));
    again += repeated.add(second, time);
    if (time > 0) CHECK_FALSE(repeated.add(first, time + 0.5));
  }
  CHECK(again == kPoints);
  CHECK(repeated.count() == 3 * kPoints);
  CHECK(repeated.near() == kPoints);  // without times they may be there by chance
  CHECK_FALSE(repeated.add({60, 60, 60}, 7));
  CHECK_FALSE(repeated.add({60, 60, 60 + 3 * kStep}, 7));
}

}  // namespace
}  // namespace lacuna::io
