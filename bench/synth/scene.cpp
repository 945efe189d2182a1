// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scene.hpp"

#include "bench/synth/arithmetic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna::synth {

namespace {

constexpr double kTooClose = 1e-6;  // metres
constexpr double kSteep = -0.3;     // of a direction's z: rays from above
constexpr int kNewtonSteps = 6;     // from 10 metres off to less than 1e-9, on gentle relief

void keep_nearer(Hit& best, double range, double cosine, double reflectance) {
  if (range > kTooClose && range < best.range) best = {range, std::fabs(cosine), reflectance, 0};
}

bool holds(const Opening& opening, double u, double v) {
  if (u < opening.u0 || u > opening.u1 || v < opening.v0 || v > opening.v1) return false;
  if (opening.kind != Opening::kArch) return true;
  const double radius = 0.5 * (opening.u1 - opening.u0);
  const double across = u - opening.u0 - radius, up = v - (opening.v1 - radius);
  return up < 0 || across * across + up * up < radius * radius;
}

// Where the beam enters and leaves a convex thing: the half spaces `depth <= 0` are cut one by one.
struct Cut {
  double enter = 0, leave, cosine = 0;

  // `depth` is the depth of the origin, `step` its growth per metre.
  void half_space(double depth, double step) {
    if (step == 0) {
      if (depth > 0) leave = -1;
      return;
    }
    const double at = -depth / step;
    if (step > 0) {
      leave = std::min(leave, at);
    } else if (at > enter) {
      enter = at;
      cosine = step;
    }
  }
};

// Both crossings with a cylinder around an axis through `start`; from > to if there are none.
struct Crossings {
  double from, to;
  double root;  // cosine of the angle of incidence times the radius
};

Crossings cross_cylinder(Vec3 start, Vec3 along, double radius, const Beam& beam) {
  const Vec3 arm = beam.origin - start;
  const Vec3 from = arm - dot(arm, along) * along;
  const Vec3 d = beam.direction - dot(beam.direction, along) * along;
  const double a = dot(d, d);
  const double b = dot(from, d);
  const double square = b * b - a * (dot(from, from) - radius * radius);
  if (a == 0 || square < 0) return {1, 0, 0};
  const double root = std::sqrt(square);
  return {(-b - root) / a, (-b + root) / a, root};
}

}  // namespace

double House::top(double y) const {
  return eaves + rise * (1 - std::fabs(y) / half_width);
}

void intersect(const Wall& wall, const Beam& ray, Hit& best) {
  const Vec3 normal = cross(wall.u, wall.v);
  const double cosine = dot(ray.direction, normal);
  if (cosine == 0) return;
  const double range = dot(wall.corner - ray.origin, normal) / cosine;
  if (!(range > kTooClose && range < best.range)) return;
  const Vec3 inside = ray.origin + range * ray.direction - wall.corner;
  const double u = dot(inside, wall.u);
  const double v = dot(inside, wall.v);
  if (u < 0 || u > wall.width || v < 0 || v > wall.height) return;
  double reflectance = wall.reflectance;
  for (const Opening& opening : wall.openings) {
    if (!holds(opening, u, v)) continue;
    if (opening.kind != Opening::kGlass) return;
    reflectance = 0;
  }
  keep_nearer(best, range, cosine, reflectance);
}

void intersect(const Box& box, const Beam& beam, Hit& best) {
  const Vec3 from = turned(box, beam.origin - box.centre);
  const Vec3 d = turned(box, beam.direction);
  Cut cut{.leave = best.range};
  const auto slab = [&](double depth, double step, double half) {
    for (const double side : {-1.0, 1.0}) cut.half_space(side * depth - half, side * step);
  };
  slab(from.x, d.x, box.half.x);
  slab(from.y, d.y, box.half.y);
  slab(from.z, d.z, box.half.z);
  if (cut.enter < cut.leave) keep_nearer(best, cut.enter, cut.cosine, box.reflectance);
}

void intersect(const Ball& ball, const Beam& ray, Hit& best) {
  const Vec3 to = ball.centre - ray.origin;
  const double middle = dot(to, ray.direction);
  const double square = ball.radius * ball.radius - (dot(to, to) - middle * middle);
  if (square < 0) return;
  const double half = std::sqrt(square);
  keep_nearer(best, middle - half, half / ball.radius, ball.reflectance);
}

void intersect(const Column& column, const Beam& ray, Hit& best) {
  const Vec3 from = ray.origin - column.base;
  const Vec3 d = ray.direction;
  if (d.z < 0) {
    const double range = (column.height - from.z) / d.z;
    const double x = from.x + range * d.x;
    const double y = from.y + range * d.y;
    if (x * x + y * y <= column.radius * column.radius) keep_nearer(best, range, d.z, column.reflectance);
  }
  const auto [range, away, root] = cross_cylinder(column.base, {0, 0, 1}, column.radius, ray);
  if (range > away) return;
  const double z = from.z + range * d.z;
  if (z < 0 || z > column.height) return;
  keep_nearer(best, range, root / column.radius, column.reflectance);
}

void intersect(const Pipe& pipe, const Beam& beam, Hit& best) {
  const auto [from, to, root] = cross_cylinder(pipe.start, pipe.along, pipe.radius, beam);
  if (from > to) return;
  const double at = dot(beam.origin + from * beam.direction - pipe.start, pipe.along);
  if (at < 0 || at > pipe.length) return;
  keep_nearer(best, from, root / pipe.radius, pipe.reflectance);
}

void intersect(const Vault& vault, const Beam& beam, Hit& best) {
  const auto [from, to, root] = cross_cylinder(vault.start, vault.along, vault.radius, beam);
  if (from > to) return;
  for (const double range : {from, to}) {
    const Vec3 arm = beam.origin + range * beam.direction - vault.start;
    const double at = dot(arm, vault.along);
    if (arm.z >= 0 && at >= 0 && at <= vault.length)
      keep_nearer(best, range, root / vault.radius, vault.reflectance);
  }
}

void intersect(const House& house, const Beam& beam, Hit& best) {
  const Vec3 from = turned(house, beam.origin - house.base);
  const Vec3 d = turned(house, beam.direction);
  const double pitch = house.rise / house.half_width, ridge = house.eaves + house.rise;
  const double slant = 1 / std::sqrt(1 + pitch * pitch);
  Cut cut{.leave = best.range};
  for (const double side : {-1.0, 1.0}) {
    cut.half_space(side * from.x - house.half_length, side * d.x);
    cut.half_space(side * from.y - house.half_width, side * d.y);
    cut.half_space(slant * (from.z + side * pitch * from.y - ridge), slant * (d.z + side * pitch * d.y));
  }
  cut.half_space(-from.z, -d.z);
  if (cut.enter < cut.leave) keep_nearer(best, cut.enter, cut.cosine, house.reflectance);
}

double Terrain::height(double x, double y) const {
  double sum = 0;
  for (const Swell& swell : swells)
    sum += swell.height * sin_cos(swell.x * x + swell.y * y + swell.phase).sin;
  return sum;
}

Vec3 Terrain::slope(double x, double y) const {
  Vec3 sum;
  for (const Swell& swell : swells) {
    const double steep = kTwoPi * swell.height * sin_cos(swell.x * x + swell.y * y + swell.phase).cos;
    sum = sum + steep * Vec3{swell.x, swell.y, 0};
  }
  return sum;
}

bool Terrain::is_water(double x, double y) const {
  const auto in_river = [&](const River& river) {
    const auto [sine, cosine] = sin_cos(river.turns_per_metre * x + river.phase);
    const double slant = kTwoPi * river.turns_per_metre * river.swing * cosine;
    const double off = y - river.middle - river.swing * sine;
    if (off * off > 0.25 * river.width * river.width * (1 + slant * slant)) return false;
    return std::none_of(river.dams.begin(), river.dams.end(),
                        [&](double dam) { return std::fabs(x - dam) < 0.5 * river.dam_width; });
  };
  const auto in_lake = [&](const Lake& lake) {
    const double right = x - lake.centre.x, up = y - lake.centre.y;
    const double u = right / lake.half_x, v = up / lake.half_y;
    return u * u + v * v < 1 && right * right + up * up > lake.island * lake.island;
  };
  return std::any_of(rivers.begin(), rivers.end(), in_river) ||
         std::any_of(lakes.begin(), lakes.end(), in_lake);
}

void intersect(const Terrain& terrain, const Beam& beam, Hit& best) {
  const Vec3 d = beam.direction;
  if (d.z > kSteep) return;
  double range = -beam.origin.z / d.z;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vec3 at = beam.origin + range * d;
    range -= (at.z - terrain.height(at.x, at.y)) / (d.z - dot(terrain.slope(at.x, at.y), d));
  }
  const Vec3 at = beam.origin + range * d;
  if (at.x < 0 || at.y < 0 || at.x > terrain.length || at.y > terrain.width) return;
  const Vec3 normal = normalized(Vec3{0, 0, 1} - terrain.slope(at.x, at.y));
  keep_nearer(best, range, dot(d, normal), terrain.is_water(at.x, at.y) ? 0 : terrain.reflectance);
}

Way way_through(const Foliage& foliage, const Beam& beam) {
  const double flat = foliage.radius / foliage.half_height;  // makes a ball of the ellipsoid
  const auto rounded = [&](Vec3 a) { return Vec3{a.x, a.y, flat * a.z}; };
  const Vec3 from = rounded(beam.origin - foliage.centre), d = rounded(beam.direction);
  const double a = dot(d, d), b = dot(from, d);
  const double square = b * b - a * (dot(from, from) - foliage.radius * foliage.radius);
  if (square <= 0) return {0, 0};
  const double root = std::sqrt(square);
  return {std::max((-b - root) / a, 0.0), std::max((-b + root) / a, 0.0)};
}

Hit cast(const Scene& scene, const Beam& beam) {
  Hit best{std::numeric_limits<double>::infinity(), 1, 0, 0};
  std::uint32_t nearest = 0;
  for_each_shape(scene, [&](const auto& shape, std::uint32_t number) {
    const double before = best.range;
    intersect(shape, beam, best);
    if (best.range < before) nearest = number;
  });
  best.shape = nearest;
  return best;
}

double share_through_leaves(const Scene& scene, const Beam& beam, double range) {
  double share = 1;
  for (const Foliage& foliage : scene.foliage) {
    const auto [from, to] = way_through(foliage, beam);
    const double inside = std::min(to, range) - from;
    if (inside > 0) share *= 1 - inside / foliage.depth;
  }
  return share;
}

const char* Scene::name_of(std::uint32_t wanted) const {
  const char* name = "";
  for_each_shape(*this, [&](const auto& shape, std::uint32_t number) {
    if (number == wanted) name = shape.name;
  });
  return name;
}

bool Scene::is_terrain(std::uint32_t shape) const {
  const std::size_t others = walls.size() + boxes.size() + balls.size() + columns.size() + pipes.size() +
                             vaults.size() + houses.size();
  return shape >= others;
}

bool occupied(const Scene& scene, Vec3 place, double clearance) {
  const auto inside_box = [&](const Box& box) {
    const Vec3 p = turned(box, place - box.centre);
    return std::fabs(p.x) < box.half.x + clearance && std::fabs(p.y) < box.half.y + clearance &&
           std::fabs(p.z) < box.half.z + clearance;
  };
  const auto inside_ball = [&](const Ball& ball) {
    const Vec3 p = place - ball.centre;
    return dot(p, p) < (ball.radius + clearance) * (ball.radius + clearance);
  };
  const auto inside_column = [&](const Column& column) {
    const Vec3 p = place - column.base;
    const double reach = column.radius + clearance;
    return p.x * p.x + p.y * p.y < reach * reach && p.z < column.height + clearance;
  };
  const auto inside_pipe = [&](const Pipe& pipe) {
    const Vec3 arm = place - pipe.start;
    const Vec3 p = arm - std::clamp(dot(arm, pipe.along), 0.0, pipe.length) * pipe.along;
    return dot(p, p) < (pipe.radius + clearance) * (pipe.radius + clearance);
  };
  return std::any_of(scene.boxes.begin(), scene.boxes.end(), inside_box) ||
         std::any_of(scene.balls.begin(), scene.balls.end(), inside_ball) ||
         std::any_of(scene.columns.begin(), scene.columns.end(), inside_column) ||
         std::any_of(scene.pipes.begin(), scene.pipes.end(), inside_pipe);
}

}  // namespace lacuna::synth
