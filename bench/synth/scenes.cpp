// SPDX-License-Identifier: Apache-2.0
// The seven scenes: a room, a court, a hall, a vault, a street, a plant, and land from the air. The floor is
// z = 0 with a corner at the origin.
#include "bench/synth/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace lacuna::synth {

namespace {

constexpr double kPaint = 0.8, kStone = 0.5, kWood = 0.6, kLeaf = 0.45, kMetal = 0.3, kBlack = 0;
constexpr Vec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

// Builds four walls, each with the openings given, from y = 0 on counterclockwise; u runs along +x or +y.
void add_walls(Scene& scene, double length, double width, double height, double reflectance,
               const std::vector<Opening> (&openings)[4]) {
  scene.walls.push_back({{0, 0, 0}, kX, kZ, length, height, reflectance, openings[0]});
  scene.walls.push_back({{length, 0, 0}, kY, kZ, width, height, reflectance, openings[1]});
  scene.walls.push_back({{0, width, 0}, kX, kZ, length, height, reflectance, openings[2]});
  scene.walls.push_back({{0, 0, 0}, kY, kZ, width, height, reflectance, openings[3]});
}

// Builds a floor or a ceiling.
void add_level(Scene& scene, const char* name, double length, double width, double z, double reflectance,
               std::vector<Opening> openings = {}) {
  scene.walls.push_back({{0, 0, z}, kX, kY, length, width, reflectance, std::move(openings), name});
}

// Builds rows of windows, `pitch` metres apart from `start` on.
std::vector<Opening> windows(int count, double start, double pitch, double width,
                             std::vector<std::pair<double, double>> floors) {
  std::vector<Opening> all;
  for (const auto& [sill, head] : floors)
    for (int i = 0; i < count; ++i)
      all.push_back({start + i * pitch, sill, start + i * pitch + width, head, Opening::kGlass});
  return all;
}

// Builds a car on its floor, with a roof that returns nothing.
void add_car(Scene& scene, Vec3 at, double cosine, double sine) {
  scene.boxes.push_back({at + Vec3{0, 0, 0.5}, {2.2, 0.9, 0.5}, cosine, sine, kMetal, "car"});
  scene.boxes.push_back({at + Vec3{0, 0, 1.25}, {1.2, 0.8, 0.25}, cosine, sine, kBlack, "car roof"});
}

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

// ---- Vault

constexpr double kNaveLength = 26, kNaveWidth = 16, kAisle = 3.4, kPier = 0.6;
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
  scene.walls.push_back({{0, aisle, 0}, kX, kZ, kNaveLength, kAisleHeight, kPaint, arches, "arcade"});
  scene.walls.push_back({{0, nave, 0}, kX, kZ, kNaveLength, kSpringing, kPaint, arches, "arcade"});
}

void add_aisle(Scene& scene, double y, double wall) {
  scene.walls.push_back(
      {{0, y, kAisleHeight}, kX, kY, kNaveLength, kAisle, kPaint, {}, "ceiling of an aisle"});
  scene.walls.push_back(
      {{0, wall, 0}, kX, kZ, kNaveLength, kAisleHeight, kPaint, windows(5, 2.3, kPitch, 1.6, {{1.8, 4.2}})});
  for (int i = 0; i < 4; ++i)
    scene.columns.push_back({{5.5 + kPitch * i, y + 0.5 * kAisle, 0}, 0.25, kAisleHeight, kStone});
}

// A barrel vault over a nave with arches, and aisles with columns.
Scene vault() {
  Scene scene;
  add_level(scene, "floor", kNaveLength, kNaveWidth, 0, kStone);
  add_arcade(scene, kAisle, kAisle + kPier);
  add_arcade(scene, kNaveWidth - kAisle, kNaveWidth - kAisle - kPier);
  add_aisle(scene, 0, 0);
  add_aisle(scene, kNaveWidth - kAisle, kNaveWidth);
  constexpr double kRadius = 0.5 * kNaveWidth - kAisle - kPier, kHeight = kSpringing + kRadius + 1;
  scene.vaults.push_back({{0, 0.5 * kNaveWidth, kSpringing}, kX, kNaveLength, kRadius, kPaint});
  scene.walls.push_back({{0, 0, 0},
                         kY,
                         kZ,
                         kNaveWidth,
                         kHeight,
                         kPaint,
                         {{7, 0, 9, 3.2, Opening::kArch}, {6.6, 6, 9.4, 8.4, Opening::kGlass}}});
  scene.walls.push_back(
      {{kNaveLength, 0, 0}, kY, kZ, kNaveWidth, kHeight, kPaint, {{7, 3, 9, 7, Opening::kGlass}}});
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

// ---- Street

constexpr double kStreetLength = 50, kStreetWidth = 16, kPavement = 3.2, kKerb = 0.14;

// Builds a line of fronts along x, each with its own height, windows in lines, and a door.
void add_fronts(Scene& scene, double y, int turn) {
  for (int i = 0; i < 4; ++i) {
    const int kind = (i + turn) % 3;
    const double height = 9 + 2.5 * kind, width = kStreetLength / 4;
    std::vector<std::pair<double, double>> floors;
    for (double sill = 4.2; sill + 2.4 < height; sill += 3.1) floors.emplace_back(sill, sill + 1.7);
    std::vector<Opening> openings = windows(4, 1.2, 2.9, 1.3, floors);
    const double door = 1.0 + 4.5 * ((i + turn) % 2);
    openings.push_back({door, kKerb, door + 1.2, 2.5, Opening::kDoor});
    openings.push_back({door + 2.2, 0.9, door + 4.8, 2.8, Opening::kGlass});
    scene.walls.push_back({{width * i, y, 0}, kX, kZ, width, height, kPaint, openings, "front"});
  }
}

void add_leafy_tree(Scene& scene, Vec3 at, double height, double crown) {
  scene.columns.push_back({at, 0.14, height, kWood, "trunk"});
  scene.foliage.push_back({at + Vec3{0, 0, height}, crown, 1.3 * crown, 4 * crown});
}

// Two fronts with windows and doors, cars, trees whose leaves fill space.
Scene street() {
  Scene scene;
  add_level(scene, "road", kStreetLength, kStreetWidth, 0, kStone);
  add_fronts(scene, 0, 0);
  add_fronts(scene, kStreetWidth, 1);
  for (const double y : {0.5 * kPavement, kStreetWidth - 0.5 * kPavement})
    scene.boxes.push_back({{kStreetLength / 2, y, kKerb / 2},
                           {kStreetLength / 2, kPavement / 2, kKerb / 2},
                           1,
                           0,
                           kStone,
                           "pavement"});
  for (const double x : {6.0, 12.0, 25.5, 38.0}) add_car(scene, {x, kPavement + 1.1, 0}, 1, 0);
  for (const double x : {9.0, 21.0, 34.0, 44.0}) add_car(scene, {x, kStreetWidth - kPavement - 1.1, 0}, 1, 0);
  add_car(scene, {31, 8.3, 0}, 0.96, 0.28);
  for (const double x : {8.0, 24.0, 40.0}) add_leafy_tree(scene, {x, 2.4, kKerb}, 5.2, 1.7);
  for (const double x : {15.0, 29.0}) add_leafy_tree(scene, {x, kStreetWidth - 2.4, kKerb}, 4.6, 1.5);
  for (const double x : {3.0, 19.0, 35.0}) {
    scene.columns.push_back({{x, kStreetWidth - 2.9, kKerb}, 0.08, 6, kMetal, "lamp post"});
    scene.boxes.push_back({{x + 4, 2.8, kKerb + 0.55}, {0.3, 0.25, 0.55}, 1, 0, kMetal, "bin"});
  }
  scene.stand_low = {4, 5.5, 1.9};
  scene.stand_high = {46, 10.5, 1.9};
  return scene;
}

// ---- Plant

constexpr double kPlantLength = 28, kPlantWidth = 18, kPlantHeight = 8;

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
  scene.pipes.push_back({{0, y, z}, kX, kPlantLength, radius, kMetal});
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

// Pipes, tanks and racks at several heights.
Scene plant() {
  Scene scene;
  add_level(scene, "floor", kPlantLength, kPlantWidth, 0, kStone);
  add_level(scene, "ceiling", kPlantLength, kPlantWidth, kPlantHeight, kMetal,
            windows(4, 3, 6, 2.5, {{7, 10}}));
  add_walls(scene, kPlantLength, kPlantWidth, kPlantHeight, kPaint,
            {windows(5, 2, 5, 3, {{5.2, 6.8}}),
             {{7, 0, 10.5, 4.2, Opening::kDoor}},
             windows(5, 2, 5, 3, {{5.2, 6.8}}),
             {}});
  add_pipe(scene, 1.2, 2.6, 0.25);
  add_pipe(scene, 1.9, 3.4, 0.15);
  add_pipe(scene, 16.6, 4.2, 0.4);
  // Across, below the ceiling, and down to a tank.
  scene.pipes.push_back({{10, 0, 6.9}, kY, kPlantWidth, 0.3, kMetal});
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
  scene.columns.push_back({{26, 9, 0}, 0.3, kPlantHeight, kPaint, "pillar"});
  scene.columns.push_back({{2, 9, 0}, 0.3, kPlantHeight, kPaint, "pillar"});
  scene.stand_low = {2, 3, 1.7};
  scene.stand_high = {26, 15.5, 1.7};
  return scene;
}

// ---- From the air

constexpr double kLandLength = 400, kLandWidth = 300;
constexpr double kPlot = 38;       // metres: at most one house is on each
constexpr double kFromWater = 16;  // of a house's middle
constexpr double kFoundation = 4;  // below the ground
constexpr int kTrees = 90;
constexpr std::uint64_t kGround = 32, kHouses = 33, kWoods = 34;  // streams of random numbers

Terrain ground_with_water(std::uint64_t seed) {
  const Random random(seed, kGround);
  Terrain ground{.length = kLandLength, .width = kLandWidth, .reflectance = kLeaf};
  ground.swells = {{1 / 260.0, 1 / 410.0, random.uniform(0), 3},
                   {-1 / 330.0, 1 / 190.0, random.uniform(1), 2},
                   {1 / 95.0, 1 / 120.0, random.uniform(2), 0.5}};
  ground.rivers = {{.middle = random.uniform(3, 100, 130),
                    .width = 30,
                    .swing = 22,
                    .turns_per_metre = 1 / random.uniform(4, 260, 380),
                    .phase = random.uniform(5),
                    .dams = {random.uniform(6, 70, 120), random.uniform(7, 290, 340)},
                    .dam_width = 12}};
  ground.lakes = {{{random.uniform(8, 90, 310), random.uniform(9, 225, 240), 0},
                   random.uniform(10, 30, 45),
                   random.uniform(11, 20, 28),
                   random.uniform(12, 6, 9)}};
  return ground;
}

bool is_near_water(const Terrain& ground, double x, double y, double reach) {
  for (int eighth = 0; eighth < 8; ++eighth) {
    const auto [sine, cosine] = sin_cos(eighth / 8.0);
    for (const double way : {0.5 * reach, reach})
      if (ground.is_water(x + way * cosine, y + way * sine)) return true;
  }
  return ground.is_water(x, y);
}

// Builds houses on three plots of four, away from water. Most have a pitched roof.
void add_houses(Scene& scene, const Terrain& ground, std::uint64_t seed) {
  const Random random(seed, kHouses);
  std::uint64_t draw = 0;
  for (double low = 0; low + kPlot <= kLandWidth; low += kPlot) {
    for (double left = 0; left + kPlot <= kLandLength; left += kPlot, draw += 10) {
      const double x = left + random.uniform(draw, 0.4, 0.6) * kPlot;
      const double y = low + random.uniform(draw + 1, 0.4, 0.6) * kPlot;
      if (random.uniform(draw + 2) > 0.75 || is_near_water(ground, x, y, kFromWater)) continue;
      const auto [sine, cosine] = sin_cos(random.uniform(draw + 3));
      const bool flat = random.uniform(draw + 4) < 0.3;
      scene.houses.push_back({.base = {x, y, ground.height(x, y) - kFoundation},
                              .half_length = random.uniform(draw + 5, 6, 10),
                              .half_width = random.uniform(draw + 6, 4, 6),
                              .eaves = kFoundation + random.uniform(draw + 7, 4.5, 9),
                              .rise = flat ? 0 : random.uniform(draw + 8, 1.5, 4),
                              .cosine = cosine,
                              .sine = sine,
                              .reflectance = kStone});
    }
  }
}

bool is_near_house(const Scene& scene, double x, double y, double reach) {
  return std::any_of(scene.houses.begin(), scene.houses.end(), [&](const House& house) {
    const Vec3 p = turned(house, Vec3{x, y, 0} - house.base);
    return std::fabs(p.x) < house.half_length + reach && std::fabs(p.y) < house.half_width + reach;
  });
}

void add_trees(Scene& scene, const Terrain& ground, std::uint64_t seed) {
  const Random random(seed, kWoods);
  for (std::uint64_t tree = 0; scene.foliage.size() < kTrees; ++tree) {
    const double radius = random.uniform(5 * tree + 2, 2, 5);
    const double x = random.uniform(5 * tree, radius, kLandLength - radius);
    const double y = random.uniform(5 * tree + 1, radius, kLandWidth - radius);
    const double half_height = radius * random.uniform(5 * tree + 3, 0.9, 1.5);
    if (is_near_water(ground, x, y, radius) || is_near_house(scene, x, y, 0.5 * radius)) continue;
    const double above = half_height + random.uniform(5 * tree + 4, 1, 4);
    scene.foliage.push_back({{x, y, ground.height(x, y) + above}, radius, half_height, 3.2 * half_height});
  }
}

// Ground with relief, river and lake, houses and trees. It is flown over.
Scene aerial(std::uint64_t seed) {
  Scene scene;
  const Terrain ground = ground_with_water(seed);
  add_houses(scene, ground, seed);
  add_trees(scene, ground, seed);
  scene.terrains.push_back(ground);
  scene.stand_high = {kLandLength, kLandWidth, 0};
  scene.flown = true;
  return scene;
}

}  // namespace

Scene make_scene(SceneKind kind, std::uint64_t seed) {
  if (kind == SceneKind::kAerial) return aerial(seed);
  constexpr std::array kScenes{room, court, hall, vault, street, plant};  // by their kind
  return kScenes[static_cast<std::size_t>(kind)]();
}

}  // namespace lacuna::synth
