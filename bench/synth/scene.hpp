// SPDX-License-Identifier: Apache-2.0
// scene: scenes of simple shapes, and what a ray hits first in them. Lengths are in metres; z is up.
//
// Idea: a ray is tried against each shape by its equation, and the ground's height is found by Newton's
// method. Cost: a ray takes as many steps as there are shapes.
#pragma once

#include "bench/synth/arithmetic.hpp"

#include <cstdint>
#include <vector>

namespace lacuna::synth {

// A ray in space.
struct Beam {
  Vec3 origin;
  Vec3 direction;  // unit
};

// What a ray hits. If nothing is within reach, `range` is infinite. Glass, water and black things have
// reflectance 0.
struct Hit {
  double range;
  double cosine;  // of the angle of incidence, (0, 1]
  double reflectance;
  std::uint32_t shape;  // its number, see for_each_shape()
};

// Part of a wall, in metres from its corner along u and v.
struct Opening {
  double u0, v0, u1, v1;
  // Glass returns nothing; rays pass through a door and an arch. The top of an arch is half a circle.
  enum { kGlass, kDoor, kArch } kind;
};

// A flat rectangle; rays hit it from both sides.
struct Wall {
  Vec3 corner;
  Vec3 u, v;  // unit, at right angles
  double width, height;
  double reflectance;
  std::vector<Opening> openings;
  const char* name = "wall";
};

// A box, turned about the vertical by the angle with this cosine and sine.
struct Box {
  Vec3 centre;
  Vec3 half;
  double cosine, sine;
  double reflectance;
  const char* name = "box";
};

struct Ball {
  Vec3 centre;
  double radius;
  double reflectance;
  const char* name = "ball";
};

// An upright cylinder with a lid.
struct Column {
  Vec3 base;
  double radius, height;
  double reflectance;
  const char* name = "column";
};

// A cylinder in any direction, hit from outside; other things close its ends.
struct Pipe {
  Vec3 start;
  Vec3 along;  // unit
  double length, radius;
  double reflectance;
  const char* name = "pipe";
};

// The upper half of a level cylinder; rays hit it from both sides.
struct Vault {
  Vec3 start;  // on its axis
  Vec3 along;  // unit, level
  double length, radius;
  double reflectance;
  const char* name = "vault";
};

// Four walls and a roof with the ridge along the house's own x; the roof is flat if `rise` is 0. It is turned
// like a box.
struct House {
  Vec3 base;
  double half_length, half_width;
  double eaves, rise;  // above the base; of the ridge above the eaves
  double cosine, sine;
  double reflectance;
  const char* name = "house";

  double top(double y) const;  // above the base, |y| <= half_width
};

// A wave of the ground's height.
struct Swell {
  double x, y;   // turns per metre
  double phase;  // turns
  double height;
};

// A river along x: its middle line is y = middle + swing * sin(turns_per_metre * x + phase). Dams cross it.
struct River {
  double middle, width;
  double swing, turns_per_metre, phase;
  std::vector<double> dams;  // x
  double dam_width;
};

// An elliptical lake with an island.
struct Lake {
  Vec3 centre;
  double half_x, half_y;
  double island;  // radius
};

// Ground with gentle relief, from the origin along x and y. It is for rays from above.
struct Terrain {
  double length, width;
  std::vector<Swell> swells;
  std::vector<River> rivers;
  std::vector<Lake> lakes;
  double reflectance;
  const char* name = "ground";

  double height(double x, double y) const;
  Vec3 slope(double x, double y) const;  // of the height along x and y; z is 0
  bool is_water(double x, double y) const;
};

// The crown of a tree: leaves throughout an ellipsoid. Leaves stop a ray anywhere, or let it pass. `depth` is
// the way through leaves that stops every ray. It is more than both diameters.
struct Foliage {
  Vec3 centre;
  double radius, half_height;
  double depth;
};

// The part of a beam inside the leaves. If there is none, `from` is no less than `to`.
struct Way {
  double from, to;
};

Way way_through(const Foliage& foliage, const Beam& beam);

// Each function replaces `best` if the ray hits the shape nearer, but leaves the number of the shape.
void intersect(const Wall& wall, const Beam& beam, Hit& best);
void intersect(const Box& box, const Beam& beam, Hit& best);
void intersect(const Ball& ball, const Beam& beam, Hit& best);
void intersect(const Column& column, const Beam& beam, Hit& best);
void intersect(const Pipe& pipe, const Beam& beam, Hit& best);
void intersect(const Vault& vault, const Beam& beam, Hit& best);
void intersect(const House& house, const Beam& beam, Hit& best);
void intersect(const Terrain& terrain, const Beam& beam, Hit& best);

// Turns a vector into the thing's own axes.
template <typename Turned>
Vec3 turned(const Turned& thing, Vec3 a) {
  return {thing.cosine * a.x + thing.sine * a.y, thing.cosine * a.y - thing.sine * a.x, a.z};
}

// Turns a vector back.
template <typename Turned>
Vec3 turned_back(const Turned& thing, Vec3 a) {
  return {thing.cosine * a.x - thing.sine * a.y, thing.sine * a.x + thing.cosine * a.y, a.z};
}

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
