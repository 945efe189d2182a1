// SPDX-License-Identifier: Apache-2.0
// Scenes of simple shapes, and what a ray hits first in them. Lengths are in metres; z is up.
#pragma once

#include "bench/synth/shapes.hpp"

#include <cstdint>
#include <vector>

namespace lacuna::synth {

struct Scene {
  std::vector<Wall> walls;
  std::vector<Box> boxes;
  std::vector<Ball> balls;
  std::vector<Column> columns;
  std::vector<Pipe> pipes;
  std::vector<Vault> vaults;
  std::vector<House> houses;
  std::vector<Terrain> terrains;
  std::vector<Foliage> foliage;  // no shapes: they have no surface
  Vec3 stand_low, stand_high;    // where a station may stand, its eye included
  bool flown = false;            // scanned from above, in strips from stand_low to stand_high

  // Returns the name of the shape with this number.
  const char* name_of(std::uint32_t shape) const;
  bool is_wall(std::uint32_t shape) const { return shape < walls.size(); }
  bool is_terrain(std::uint32_t shape) const;
};

// Calls `use(shape, number)` for each shape, in the order of their numbers.
template <typename Use>
void for_each_shape(const Scene& scene, const Use& use) {
  std::uint32_t number = 0;
  const auto use_all = [&](const auto& shapes) {
    for (const auto& shape : shapes) use(shape, number++);
  };
  use_all(scene.walls);
  use_all(scene.boxes);
  use_all(scene.balls);
  use_all(scene.columns);
  use_all(scene.pipes);
  use_all(scene.vaults);
  use_all(scene.houses);
  use_all(scene.terrains);
}

enum class SceneKind { kRoom, kCourt, kHall, kVault, kStreet, kPlant, kAerial };

// The seed places houses and trees of the aerial scene. The other scenes are always the same.
Scene make_scene(SceneKind kind, std::uint64_t seed = 1);

// Returns the nearest hit by range. Cost: the function tries every shape.
Hit cast(const Scene& scene, const Beam& beam);

// Returns the share of rays that pass the leaves within `range`.
double share_through_leaves(const Scene& scene, const Beam& beam, double range);

// Whether a shape is closer than `clearance` to this place. The function ignores walls, vaults, houses and
// ground.
bool occupied(const Scene& scene, Vec3 place, double clearance);

}  // namespace lacuna::synth
