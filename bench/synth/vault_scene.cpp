// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scenes.hpp"

#include <algorithm>

namespace lacuna::synth {

namespace {

constexpr double kLength = 26, kWidth = 16, kAisle = 3.4, kPier = 0.6;
constexpr double kSpringing = 6, kAisleHeight = 5;
constexpr double kArch = 3.2, kArchHeight = 4.4, kPitch = 4.8;
constexpr double kLip = 8e-4;  // of a front before the inside of its arch, so that rounding finds no gap

// Builds five arches through a wall along x, from the aisle's side at `aisle` to the nave's at `nave`.
void add_arcade(Scene& scene, double aisle, double nave) {
  constexpr double kRadius = 0.5 * kArch, kFoot = kArchHeight - kRadius;
  const double low = std::min(aisle, nave);
  std::vector<Opening> arches;
  for (int i = 0; i < 5; ++i) {
    const double left = 1.5 + kPitch * i;
    arches.push_back({left, 0, left + kArch, kArchHeight, Opening::kArch});
    scene.vaults.push_back({{left + kRadius, low, kFoot}, kY, kPier, kRadius + kLip, kPaint, "arch"});
    for (const double x : {left - kLip, left + kArch + kLip})
      scene.walls.push_back({{x, low, 0}, kY, kZ, kPier, kFoot, kPaint, {}, "pier"});
  }
  scene.walls.push_back({{0, aisle, 0}, kX, kZ, kLength, kAisleHeight, kPaint, arches, "arcade"});
  scene.walls.push_back({{0, nave, 0}, kX, kZ, kLength, kSpringing, kPaint, arches, "arcade"});
}

void add_aisle(Scene& scene, double y, double wall) {
  scene.walls.push_back({{0, y, kAisleHeight}, kX, kY, kLength, kAisle, kPaint, {}, "ceiling of an aisle"});
  scene.walls.push_back(
      {{0, wall, 0}, kX, kZ, kLength, kAisleHeight, kPaint, windows(5, 2.3, kPitch, 1.6, {{1.8, 4.2}})});
  for (int i = 0; i < 4; ++i)
    scene.columns.push_back({{5.5 + kPitch * i, y + 0.5 * kAisle, 0}, 0.25, kAisleHeight, kStone});
}

}  // namespace

Scene vault() {
  Scene scene;
  add_level(scene, "floor", kLength, kWidth, 0, kStone);
  add_arcade(scene, kAisle, kAisle + kPier);
  add_arcade(scene, kWidth - kAisle, kWidth - kAisle - kPier);
  add_aisle(scene, 0, 0);
  add_aisle(scene, kWidth - kAisle, kWidth);
  constexpr double kRadius = 0.5 * kWidth - kAisle - kPier, kHeight = kSpringing + kRadius + 1;
  scene.vaults.push_back({{0, 0.5 * kWidth, kSpringing}, kX, kLength, kRadius, kPaint});
  scene.walls.push_back({{0, 0, 0},
                         kY,
                         kZ,
                         kWidth,
                         kHeight,
                         kPaint,
                         {{7, 0, 9, 3.2, Opening::kArch}, {6.6, 6, 9.4, 8.4, Opening::kGlass}}});
  scene.walls.push_back({{kLength, 0, 0}, kY, kZ, kWidth, kHeight, kPaint, {{7, 3, 9, 7, Opening::kGlass}}});
  for (int i = 0; i < 5; ++i)
    for (const double y : {6.3, 9.7})
      scene.boxes.push_back({{6.0 + 2.2 * i, y, 0.45}, {0.25, 1.1, 0.45}, 1, 0, kWood, "pew"});
  scene.boxes.push_back({{22, 8, 0.15}, {2, 2.6, 0.15}, 1, 0, kStone, "step"});
  scene.boxes.push_back({{22.4, 8, 0.8}, {0.5, 1.2, 0.5}, 1, 0, kStone, "altar"});
  scene.columns.push_back({{3.5, 6, 0}, 0.4, 1.1, kStone, "font"});
  scene.balls.push_back({{12, 8, 5.5}, 0.5, kMetal, "lamp"});
  scene.stand_low = {2, 1, 1.7};
  scene.stand_high = {24, 15, 1.7};
  return scene;
}

}  // namespace lacuna::synth
