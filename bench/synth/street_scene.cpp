// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scenes.hpp"

namespace lacuna::synth {

namespace {

constexpr double kLength = 50, kWidth = 16, kPavement = 3.2, kKerb = 0.14;

// Builds a line of fronts along x, each with its own height, windows in lines, and a door.
void add_fronts(Scene& scene, double y, int turn) {
  for (int i = 0; i < 4; ++i) {
    const int kind = (i + turn) % 3;
    const double height = 9 + 2.5 * kind, width = kLength / 4;
    std::vector<std::pair<double, double>> floors;
    for (double sill = 4.2; sill + 2.4 < height; sill += 3.1) floors.emplace_back(sill, sill + 1.7);
    std::vector<Opening> openings = windows(4, 1.2, 2.9, 1.3, floors);
    const double door = 1.0 + 4.5 * ((i + turn) % 2);
    openings.push_back({door, kKerb, door + 1.2, 2.5, Opening::kDoor});
    openings.push_back({door + 2.2, 0.9, door + 4.8, 2.8, Opening::kGlass});
    scene.walls.push_back({{width * i, y, 0}, kX, kZ, width, height, kPaint, openings, "front"});
  }
}

void add_tree(Scene& scene, Vec3 at, double height, double crown) {
  scene.columns.push_back({at, 0.14, height, kWood, "trunk"});
  scene.foliage.push_back({at + Vec3{0, 0, height}, crown, 1.3 * crown, 4 * crown});
}

}  // namespace

Scene street() {
  Scene scene;
  add_level(scene, "road", kLength, kWidth, 0, kStone);
  add_fronts(scene, 0, 0);
  add_fronts(scene, kWidth, 1);
  for (const double y : {0.5 * kPavement, kWidth - 0.5 * kPavement})
    scene.boxes.push_back(
        {{kLength / 2, y, kKerb / 2}, {kLength / 2, kPavement / 2, kKerb / 2}, 1, 0, kStone, "pavement"});
  for (const double x : {6.0, 12.0, 25.5, 38.0}) add_car(scene, {x, kPavement + 1.1, 0}, 1, 0);
  for (const double x : {9.0, 21.0, 34.0, 44.0}) add_car(scene, {x, kWidth - kPavement - 1.1, 0}, 1, 0);
  add_car(scene, {31, 8.3, 0}, 0.96, 0.28);
  for (const double x : {8.0, 24.0, 40.0}) add_tree(scene, {x, 2.4, kKerb}, 5.2, 1.7);
  for (const double x : {15.0, 29.0}) add_tree(scene, {x, kWidth - 2.4, kKerb}, 4.6, 1.5);
  for (const double x : {3.0, 19.0, 35.0}) {
    scene.columns.push_back({{x, kWidth - 2.9, kKerb}, 0.08, 6, kMetal, "lamp post"});
    scene.boxes.push_back({{x + 4, 2.8, kKerb + 0.55}, {0.3, 0.25, 0.55}, 1, 0, kMetal, "bin"});
  }
  scene.stand_low = {4, 5.5, 1.9};
  scene.stand_high = {46, 10.5, 1.9};
  return scene;
}

}  // namespace lacuna::synth
