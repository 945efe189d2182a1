// SPDX-License-Identifier: Apache-2.0
// The scenes themselves, and what they are made of. The floor is z = 0 with a corner at the origin.
#pragma once

#include "bench/synth/scene.hpp"

#include <utility>
#include <vector>

namespace lacuna::synth {

inline constexpr double kPaint = 0.8, kStone = 0.5, kWood = 0.6, kLeaf = 0.45, kMetal = 0.3, kBlack = 0;
inline constexpr Vec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

// Builds four walls, each with the openings given, from y = 0 on counterclockwise; u runs along +x or +y.
void add_walls(Scene& scene, double length, double width, double height, double reflectance,
               const std::vector<Opening> (&openings)[4]);

// Builds a floor or a ceiling.
void add_level(Scene& scene, const char* name, double length, double width, double z, double reflectance,
               std::vector<Opening> openings = {});

// Builds rows of windows, `pitch` metres apart from `start` on.
std::vector<Opening> windows(int count, double start, double pitch, double width,
                             std::vector<std::pair<double, double>> floors);

// Builds a house on its floor, with a roof that returns nothing.
void add_car(Scene& scene, Vec3 at, double cosine, double sine);

Scene vault();   // a barrel vault over a nave with arches, and aisles with columns
Scene street();  // two fronts with windows and doors, cars, trees whose leaves fill space
Scene plant();   // pipes, tanks and racks at several heights

// Ground with relief, river and lake, houses and trees. It is flown over.
Scene aerial(std::uint64_t seed);

}  // namespace lacuna::synth
