// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scenes.hpp"

namespace lacuna::synth {

namespace {

constexpr double kLength = 28, kWidth = 18, kHeight = 8;

// Adds two sides, and shelves with crates at several heights.
void add_rack(Scene& scene, Vec3 at) {
  for (const double x : {-1.7, 1.7})
    scene.boxes.push_back({at + Vec3{x, 0, 1.8}, {0.06, 0.6, 1.8}, 1, 0, kMetal, "rack"});
  for (const double z : {0.5, 1.9, 3.3}) {
    scene.boxes.push_back({at + Vec3{0, 0, z}, {1.64, 0.55, 0.05}, 1, 0, kMetal, "shelf"});
    scene.boxes.push_back({at + Vec3{0.5 - 0.4 * z, 0, z + 0.4}, {0.45, 0.35, 0.35}, 1, 0, kWood, "crate"});
  }
}

// The pipe runs from wall to wall along x, with legs to the floor.
void add_pipe(Scene& scene, double y, double z, double radius) {
  scene.pipes.push_back({{0, y, z}, kX, kLength, radius, kMetal});
  for (const double x : {7.0, 14.0, 21.0})
    scene.columns.push_back({{x, y, 0}, 0.08, z - radius, kMetal, "leg"});
}

void add_upright_tank(Scene& scene, Vec3 base, double radius, double height) {
  scene.columns.push_back({base, radius, height, kMetal, "tank"});
  scene.balls.push_back({base + Vec3{0, 0, height}, radius, kMetal, "tank"});
}

void add_level_tank(Scene& scene, Vec3 start, double length, double radius) {
  scene.pipes.push_back({start, kY, length, radius, kPaint, "tank"});
  for (const double y : {0.0, length}) scene.balls.push_back({start + y * kY, radius, kPaint, "tank"});
  for (const double y : {0.2 * length, 0.8 * length})
    scene.boxes.push_back({{start.x, start.y + y, 0.35}, {0.5, 0.15, 0.35}, 1, 0, kStone, "saddle"});
}

}  // namespace

Scene plant() {
  Scene scene;
  add_level(scene, "floor", kLength, kWidth, 0, kStone);
  add_level(scene, "ceiling", kLength, kWidth, kHeight, kMetal, windows(4, 3, 6, 2.5, {{7, 10}}));
  add_walls(scene, kLength, kWidth, kHeight, kPaint,
            {windows(5, 2, 5, 3, {{5.2, 6.8}}),
             {{7, 0, 10.5, 4.2, Opening::kDoor}},
             windows(5, 2, 5, 3, {{5.2, 6.8}}),
             {}});
  add_pipe(scene, 1.2, 2.6, 0.25);
  add_pipe(scene, 1.9, 3.4, 0.15);
  add_pipe(scene, 16.6, 4.2, 0.4);
  // Across, below the ceiling, and down to a tank.
  scene.pipes.push_back({{10, 0, 6.9}, kY, kWidth, 0.3, kMetal});
  scene.pipes.push_back({{18, 0, 6.2}, kY, 12, 0.2, kMetal});
  scene.balls.push_back({{18, 12, 6.2}, 0.2, kMetal, "bend"});
  scene.pipes.push_back({{18, 12, 3.5}, kZ, 2.7, 0.2, kMetal});
  add_upright_tank(scene, {18, 12, 0}, 1.3, 2.6);
  add_upright_tank(scene, {22.5, 12.5, 0}, 1.6, 3.4);
  add_upright_tank(scene, {22.5, 5, 0}, 1.1, 1.6);
  add_level_tank(scene, {5, 9.5, 1.5}, 4, 1);
  add_level_tank(scene, {8.2, 9.5, 1.5}, 4, 1);
  add_rack(scene, {6, 5, 0});
  add_rack(scene, {11, 5, 0});
  add_rack(scene, {16.5, 5, 0});
  scene.boxes.push_back({{13, 12.5, 0.7}, {1.1, 0.7, 0.7}, 0.8, 0.6, kMetal, "pump"});
  scene.columns.push_back({{13, 12.5, 1.4}, 0.35, 0.6, kBlack, "motor"});
  scene.columns.push_back({{26, 9, 0}, 0.3, kHeight, kPaint, "pillar"});
  scene.columns.push_back({{2, 9, 0}, 0.3, kHeight, kPaint, "pillar"});
  scene.stand_low = {2, 3, 1.7};
  scene.stand_high = {26, 15.5, 1.7};
  return scene;
}

}  // namespace lacuna::synth
