// Scenes of simple shapes, and what a ray hits first in them. Metres; z is up.
#pragma once

#include "tools/synth/vec3.hpp"

#include <cstdint>
#include <vector>

namespace lacuna::synth {

// What a ray hits. Nothing within reach: `range` is infinite. Glass and black things have reflectance 0.
struct Hit {
  double range;
  double cosine;  // of the angle of incidence, (0, 1]
  double reflectance;
  std::uint32_t shape;  // its number: walls first, then boxes, balls and columns
};

// Part of a wall, in metres from its corner along u and v.
struct Opening {
  double u0, v0, u1, v1;
  enum { kGlass, kDoor } kind;  // glass returns nothing; through a door one sees on
};

// A flat rectangle; seen from both sides.
struct Wall {
  Vec3 corner;
  Vec3 u, v;  // unit, at right angles
  double width, height;
  double reflectance;
  std::vector<Opening> openings;
  const char* name = "wall";
};

// Turned about the vertical by the angle with this cosine and sine.
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

// Upright, with a lid.
struct Column {
  Vec3 base;
  double radius, height;
  double reflectance;
  const char* name = "column";
};

struct Scene {
  std::vector<Wall> walls;
  std::vector<Box> boxes;
  std::vector<Ball> balls;
  std::vector<Column> columns;
  Vec3 stand_low, stand_high;  // where a station may stand, its eye included

  // The name of the shape with this number (Hit::shape).
  const char* name_of(std::uint32_t shape) const;
};

enum class SceneKind { kRoom, kCourt, kHall };

Scene make_scene(SceneKind kind);

// `direction` is a unit vector. The nearest by range; every shape is tried.
Hit cast(const Scene& scene, Vec3 origin, Vec3 direction);

// Is a shape closer than `clearance` to this place? (Walls are not looked at.)
bool occupied(const Scene& scene, Vec3 place, double clearance);

}  // namespace lacuna::synth
