// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scenes.hpp"

namespace lacuna::synth {

void add_walls(Scene& scene, double length, double width, double height, double reflectance,
               const std::vector<Opening> (&openings)[4]) {
  scene.walls.push_back({{0, 0, 0}, kX, kZ, length, height, reflectance, openings[0]});
  scene.walls.push_back({{length, 0, 0}, kY, kZ, width, height, reflectance, openings[1]});
  scene.walls.push_back({{0, width, 0}, kX, kZ, length, height, reflectance, openings[2]});
  scene.walls.push_back({{0, 0, 0}, kY, kZ, width, height, reflectance, openings[3]});
}

void add_level(Scene& scene, const char* name, double length, double width, double z, double reflectance,
               std::vector<Opening> openings) {
  scene.walls.push_back({{0, 0, z}, kX, kY, length, width, reflectance, std::move(openings), name});
}

std::vector<Opening> windows(int count, double start, double pitch, double width,
                             std::vector<std::pair<double, double>> floors) {
  std::vector<Opening> all;
  for (const auto& [sill, head] : floors)
    for (int i = 0; i < count; ++i)
      all.push_back({start + i * pitch, sill, start + i * pitch + width, head, Opening::kGlass});
  return all;
}

void add_car(Scene& scene, Vec3 at, double cosine, double sine) {
  scene.boxes.push_back({at + Vec3{0, 0, 0.5}, {2.2, 0.9, 0.5}, cosine, sine, kMetal, "car"});
  scene.boxes.push_back({at + Vec3{0, 0, 1.25}, {1.2, 0.8, 0.25}, cosine, sine, kBlack, "car roof"});
}

namespace {

void add_table(Scene& scene, Vec3 at, double length, double width) {
  scene.boxes.push_back({at + Vec3{0, 0, 0.72}, {length / 2, width / 2, 0.02}, 1, 0, kWood, "table top"});
  for (const double x : {-length / 2 + 0.06, length / 2 - 0.06})
    for (const double y : {-width / 2 + 0.06, width / 2 - 0.06})
      scene.boxes.push_back({at + Vec3{x, y, 0.35}, {0.03, 0.03, 0.35}, 1, 0, kWood, "table leg"});
}

void add_tree(Scene& scene, Vec3 at, double height, double crown) {
  scene.columns.push_back({at, 0.15, height, kWood, "trunk"});
  scene.balls.push_back({at + Vec3{0, 0, height}, crown, kLeaf, "crown"});
  scene.balls.push_back(
      {at + Vec3{0.6 * crown, 0.3 * crown, height - 0.4 * crown}, 0.6 * crown, kLeaf, "crown"});
}

Scene room() {
  Scene scene;
  add_level(scene, "floor", 8, 6, 0, kWood);
  add_level(scene, "ceiling", 8, 6, 2.8, kPaint);
  add_walls(scene, 8, 6, 2.8, kPaint,
            {windows(2, 1.2, 3.2, 1.8, {{0.9, 2.3}}), {{4.4, 0, 5.3, 2.1, Opening::kDoor}}, {}, {}});
  scene.walls.push_back({{9.5, 2, 0}, kY, kZ, 6, 2.8, kPaint, {}, "corridor wall"});  // through the door
  add_table(scene, {3.2, 2.4, 0}, 1.8, 0.9);
  scene.boxes.push_back({{3.0, 2.4, 0.95}, {0.28, 0.02, 0.2}, 0.8, 0.6, kBlack, "screen"});
  scene.boxes.push_back({{0.25, 4.2, 1.0}, {0.25, 0.8, 1.0}, 1, 0, kWood, "cupboard"});
  scene.boxes.push_back({{6.6, 5.5, 0.4}, {0.9, 0.4, 0.4}, 1, 0, kStone, "sofa"});
  scene.boxes.push_back({{6.6, 1.2, 0.25}, {0.3, 0.3, 0.25}, 12.0 / 13, 5.0 / 13, kWood, "crate"});
  scene.balls.push_back({{5.2, 3.6, 0.35}, 0.35, kPaint});
  scene.balls.push_back({{3.2, 2.5, 2.2}, 0.2, kPaint, "lamp"});
  scene.columns.push_back({{5.6, 2.2, 0}, 0.2, 2.8, kPaint});
  scene.columns.push_back({{7.6, 0.4, 0}, 0.18, 0.6, kMetal, "bin"});
  scene.stand_low = {0.8, 0.8, 1.5};
  scene.stand_high = {7.2, 5.2, 1.5};
  return scene;
}

Scene court() {
  Scene scene;
  add_level(scene, "ground", 30, 22, 0, kStone);
  std::vector<Opening> gate = windows(7, 1.5, 4, 1.4, {{5, 7}, {8.5, 10.2}});
  gate.push_back({13, 0, 17, 4, Opening::kDoor});
  add_walls(scene, 30, 22, 12, kPaint,
            {gate, windows(5, 1.8, 4, 1.4, {{1, 3}, {5, 7}, {8.5, 10.2}}),
             windows(7, 1.5, 4, 1.4, {{1, 3}, {5, 7}, {8.5, 10.2}}),
             windows(5, 1.8, 4, 1.4, {{5, 7}, {8.5, 10.2}})});
  scene.walls.push_back({{0, 0, 4.2}, kY, kX, 22, 3, kStone, {}, "arcade roof"});  // along x = 0
  for (int i = 0; i < 8; ++i) scene.columns.push_back({{3, 1.5 + 2.7 * i, 0}, 0.25, 4.2, kStone});
  scene.columns.push_back({{16, 11, 0}, 2, 0.6, kStone, "fountain"});
  scene.columns.push_back({{16, 11, 0.6}, 0.3, 1.2, kStone, "fountain"});
  scene.balls.push_back({{16, 11, 2.1}, 0.5, kStone, "fountain"});
  add_tree(scene, {9, 6, 0}, 4.5, 1.6);
  add_tree(scene, {23, 5, 0}, 5.5, 2);
  add_tree(scene, {24, 16, 0}, 4, 1.5);
  add_tree(scene, {10, 17, 0}, 5, 1.8);
  for (const double y : {8.5, 13.5})
    scene.boxes.push_back({{20.5, y, 0.25}, {0.25, 1, 0.25}, 0.8, 0.6, kWood, "bench"});
  scene.boxes.push_back({{27, 11, 0.8}, {1, 2.2, 0.8}, 1, 0, kMetal, "car"});
  scene.boxes.push_back({{27, 11.2, 1.75}, {0.9, 1.2, 0.25}, 1, 0, kBlack, "car roof"});
  scene.stand_low = {5, 2.5, 1.7};
  scene.stand_high = {28, 19.5, 1.7};
  return scene;
}

Scene hall() {
  Scene scene;
  add_level(scene, "floor", 60, 25, 0, kStone);
  add_level(scene, "ceiling", 60, 25, 9, kMetal, windows(9, 3.5, 6, 2.5, {{5, 9}, {16, 20}}));  // skylights
  std::vector<Opening> gates = {{9, 0, 14, 5, Opening::kDoor}};
  add_walls(scene, 60, 25, 9, kPaint,
            {windows(14, 2, 4, 2.4, {{5.5, 7.5}}), gates, windows(14, 2, 4, 2.4, {{5.5, 7.5}}), {}});
  scene.walls.push_back({{38, 0, 0},
                         kY,
                         kZ,
                         25,
                         9,
                         kPaint,
                         {{10, 0, 15, 5, Opening::kDoor}, {3, 1, 7, 2.5, Opening::kGlass}},
                         "inner wall"});
  for (int i = 1; i < 10; ++i)
    for (const double y : {8.0, 17.0}) scene.columns.push_back({{6.0 * i, y, 0}, 0.3, 9, kMetal});
  for (int i = 0; i < 6; ++i) {
    const double size = 0.5 + 0.1 * (i % 3);
    scene.boxes.push_back(
        {{9.0 + 4.5 * i, 3.0 + 0.3 * i, size}, {size, size, size}, 0.8, i % 2 ? 0.6 : -0.6, kWood, "crate"});
    scene.boxes.push_back({{8.0 + 5.0 * i, 21.5, 1.5}, {1.8, 0.6, 1.5}, 1, 0, kMetal, "rack"});
  }
  scene.columns.push_back({{47, 5, 0}, 1.8, 5, kMetal, "tank"});
  scene.columns.push_back({{52, 5, 0}, 1.8, 5, kMetal, "tank"});
  scene.balls.push_back({{47, 5, 5}, 1.8, kMetal, "tank"});
  scene.balls.push_back({{50, 20, 2}, 2, kPaint});
  scene.boxes.push_back({{21, 12.5, 0.9}, {2.5, 1, 0.9}, 12.0 / 13, 5.0 / 13, kMetal, "machine"});
  scene.boxes.push_back({{21, 12.5, 2.1}, {0.8, 0.5, 0.3}, 12.0 / 13, 5.0 / 13, kBlack, "machine"});
  add_table(scene, {30, 12, 0}, 2.4, 1.2);
  add_table(scene, {43, 13, 0}, 2.4, 1.2);
  scene.stand_low = {2, 2, 1.7};
  scene.stand_high = {58, 23, 1.7};
  return scene;
}

}  // namespace

Scene make_scene(SceneKind kind, std::uint64_t seed) {
  switch (kind) {
    case SceneKind::kCourt:
      return court();
    case SceneKind::kHall:
      return hall();
    case SceneKind::kVault:
      return vault();
    case SceneKind::kStreet:
      return street();
    case SceneKind::kPlant:
      return plant();
    case SceneKind::kAerial:
      return aerial(seed);
    case SceneKind::kRoom:
      break;
  }
  return room();
}

}  // namespace lacuna::synth
