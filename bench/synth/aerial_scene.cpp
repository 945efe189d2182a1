// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/random.hpp"
#include "bench/synth/scenes.hpp"
#include "bench/synth/trig.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna::synth {

namespace {

constexpr double kLength = 400, kWidth = 300;
constexpr double kPlot = 38;       // metres: at most one house is on each
constexpr double kFromWater = 16;  // of a house's middle
constexpr double kFoundation = 4;  // below the ground
constexpr int kTrees = 90;
constexpr std::uint64_t kGround = 32, kHouses = 33, kWoods = 34;  // streams of random numbers

Terrain ground_with_water(std::uint64_t seed) {
  const Random random(seed, kGround);
  Terrain ground{.length = kLength, .width = kWidth, .reflectance = kLeaf};
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
  for (double low = 0; low + kPlot <= kWidth; low += kPlot) {
    for (double left = 0; left + kPlot <= kLength; left += kPlot, draw += 10) {
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
    const double x = random.uniform(5 * tree, radius, kLength - radius);
    const double y = random.uniform(5 * tree + 1, radius, kWidth - radius);
    const double half_height = radius * random.uniform(5 * tree + 3, 0.9, 1.5);
    if (is_near_water(ground, x, y, radius) || is_near_house(scene, x, y, 0.5 * radius)) continue;
    const double above = half_height + random.uniform(5 * tree + 4, 1, 4);
    scene.foliage.push_back({{x, y, ground.height(x, y) + above}, radius, half_height, 3.2 * half_height});
  }
}

}  // namespace

Scene aerial(std::uint64_t seed) {
  Scene scene;
  const Terrain ground = ground_with_water(seed);
  add_houses(scene, ground, seed);
  add_trees(scene, ground, seed);
  scene.terrains.push_back(ground);
  scene.stand_high = {kLength, kWidth, 0};
  scene.flown = true;
  return scene;
}

}  // namespace lacuna::synth
