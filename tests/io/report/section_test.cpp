// SPDX-License-Identifier: Apache-2.0
#include "io/report/section.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::io {
namespace {

// Points at heights 100 to 109, and loops of three vertices: at 102, at 108, and from 104 to 106.
Scene tower() {
  Scene scene;
  scene.origin = {5e5, 5e6, 100};
  for (int z = 0; z < 10; ++z) {
    scene.points.positions.push_back({0, 0, float(z)});
    scene.points.probabilities.push_back(float(z) / 10);
    scene.points.normals.push_back({0, 0, z % 2 == 0 ? 1.0f : -1.0f});
  }
  for (const auto& [a, b, c] : {std::array{2, 2, 2}, {8, 8, 8}, {4, 5, 6}}) {
    for (const int z : {a, b, c}) scene.loops.vertices.push_back({1, 1, float(z)});
    scene.loops.first.push_back(3 * scene.loops.ids.size());
    scene.loops.ids.push_back(10 + scene.loops.ids.size());
    scene.loops.measures.push_back({{.points = 3, .diameter = double(a)}, {}});
  }
  scene.loops.first.push_back(9);
  return scene;
}

TEST_CASE("a section hides points above it, and loops that lie above it as a whole") {
  Scene scene = tower();
  hide_above(scene, 105);
  REQUIRE(scene.points.positions.size() == 6);
  CHECK(scene.points.positions.back().z() == 5);
  CHECK(scene.points.probabilities == std::vector<float>{0, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f});
  CHECK(scene.points.normals.size() == 6);
  CHECK(scene.points.colours.empty());
  CHECK(scene.loops.ids == std::vector<std::uint64_t>{10, 12});
  CHECK(scene.loops.first == std::vector<std::size_t>{0, 3, 6});
  CHECK(scene.loops.measures[1].diameter == 4);
  CHECK(scene.loops.vertices[5].z() == 6);
}

TEST_CASE("a section above everything hides nothing, one below everything all") {
  Scene scene = tower();
  hide_above(scene, 109);
  CHECK(scene.points.positions.size() == 10);
  CHECK(scene.loops.ids.size() == 3);
  hide_above(scene, 99.5);
  CHECK(scene.points.positions.empty());
  CHECK(scene.loops.ids.empty());
  CHECK(scene.loops.first == std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace lacuna::io
