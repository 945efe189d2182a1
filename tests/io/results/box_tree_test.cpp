// SPDX-License-Identifier: Apache-2.0
#include "io/results/box_tree.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <catch2/catch.hpp>

namespace lacuna::io {
namespace {

std::multiset<std::size_t> found(const BoxTree& tree, const Eigen::Vector3d& point) {
  std::multiset<std::size_t> boxes;
  tree.for_each_around(point, [&](std::size_t box) { boxes.insert(box); });
  return boxes;
}

}  // namespace

TEST_CASE("a tree of boxes finds those that a search through all of them finds", "[io]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 10), size(0, 2);
  for (const std::size_t count : {0u, 1u, 4u, 5u, 300u}) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d low(place(random), place(random), place(random));
      boxes.emplace_back(low, low + Eigen::Vector3d(size(random), size(random), size(random)));
    }
    if (count > 4) boxes[3] = boxes[2];  // two equal ones
    const BoxTree tree(boxes);
    std::size_t hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d point(place(random), place(random), place(random));
      std::multiset<std::size_t> expected;
      for (std::size_t box = 0; box < count; ++box) {
        if (boxes[box].contains(point)) expected.insert(box);
      }
      hits += expected.size();
      CHECK(found(tree, point) == expected);
    }
    CHECK((count < 300 || hits > 300));
  }
}

TEST_CASE("the borders of a box belong to it, and a point that is not finite lies in none", "[io]") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const BoxTree tree({{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 2, 3)},
                      {Eigen::Vector3d::Constant(-1e300), Eigen::Vector3d::Constant(1e300)}});
  CHECK(found(tree, {1, 2, 3}) == std::multiset<std::size_t>{0, 1});
  CHECK(found(tree, {0, 0, 0}) == std::multiset<std::size_t>{0, 1});
  CHECK(found(tree, {std::nextafter(1.0, 2.0), 2, 3}) == std::multiset<std::size_t>{1});
  CHECK(found(tree, {std::nan(""), 1, 1}).empty());
  CHECK(found(tree, {kInfinity, 1, 1}).empty());
}

}  // namespace lacuna::io
