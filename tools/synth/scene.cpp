#include "tools/synth/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna::synth {

namespace {

constexpr double kTooClose = 1e-6;  // metres

struct Ray {
  Vec3 origin, direction;
};

void keep_nearer(Hit& best, double range, double cosine, double reflectance) {
  if (range > kTooClose && range < best.range) best = {range, std::fabs(cosine), reflectance, 0};
}

void meet(const Wall& wall, const Ray& ray, Hit& best) {
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
    if (u < opening.u0 || u > opening.u1 || v < opening.v0 || v > opening.v1) continue;
    if (opening.kind == Opening::kDoor) return;
    reflectance = 0;
  }
  keep_nearer(best, range, cosine, reflectance);
}

// Into the box's own axes.
Vec3 turned(const Box& box, Vec3 a) {
  return {box.cosine * a.x + box.sine * a.y, box.cosine * a.y - box.sine * a.x, a.z};
}

void meet(const Box& box, const Ray& ray, Hit& best) {
  const Vec3 from = turned(box, ray.origin - box.centre);
  const Vec3 along = turned(box, ray.direction);
  double enter = 0, leave = best.range, cosine = 0;
  const auto cut = [&](double start, double step, double half) {
    if (step == 0) {
      if (std::fabs(start) > half) leave = -1;
      return;
    }
    const double near = ((step > 0 ? -half : half) - start) / step;
    const double far = ((step > 0 ? half : -half) - start) / step;
    if (near > enter) {
      enter = near;
      cosine = step;
    }
    leave = std::min(leave, far);
  };
  cut(from.x, along.x, box.half.x);
  cut(from.y, along.y, box.half.y);
  cut(from.z, along.z, box.half.z);
  if (enter < leave) keep_nearer(best, enter, cosine, box.reflectance);
}

void meet(const Ball& ball, const Ray& ray, Hit& best) {
  const Vec3 to = ball.centre - ray.origin;
  const double middle = dot(to, ray.direction);
  const double square = ball.radius * ball.radius - (dot(to, to) - middle * middle);
  if (square < 0) return;
  const double half = std::sqrt(square);
  keep_nearer(best, middle - half, half / ball.radius, ball.reflectance);
}

void meet(const Column& column, const Ray& ray, Hit& best) {
  const Vec3 from = ray.origin - column.base;
  const Vec3 d = ray.direction;
  if (d.z < 0) {
    const double range = (column.height - from.z) / d.z;
    const double x = from.x + range * d.x;
    const double y = from.y + range * d.y;
    if (x * x + y * y <= column.radius * column.radius) keep_nearer(best, range, d.z, column.reflectance);
  }
  const double a = d.x * d.x + d.y * d.y;
  if (a == 0) return;
  const double b = from.x * d.x + from.y * d.y;
  const double square = b * b - a * (from.x * from.x + from.y * from.y - column.radius * column.radius);
  if (square < 0) return;
  const double range = (-b - std::sqrt(square)) / a;
  const double z = from.z + range * d.z;
  if (z < 0 || z > column.height) return;
  keep_nearer(best, range, std::sqrt(square) / column.radius, column.reflectance);
}

}  // namespace

Hit cast(const Scene& scene, Vec3 origin, Vec3 direction) {
  const Ray ray{origin, direction};
  Hit best{std::numeric_limits<double>::infinity(), 1, 0, 0};
  std::uint32_t shape = 0, nearest = 0;
  const auto meet_all = [&](const auto& shapes) {
    for (const auto& one : shapes) {
      const double before = best.range;
      meet(one, ray, best);
      if (best.range < before) nearest = shape;
      ++shape;
    }
  };
  meet_all(scene.walls);
  meet_all(scene.boxes);
  meet_all(scene.balls);
  meet_all(scene.columns);
  best.shape = nearest;
  return best;
}

const char* Scene::name_of(std::uint32_t shape) const {
  if (shape < walls.size()) return walls[shape].name;
  shape -= static_cast<std::uint32_t>(walls.size());
  if (shape < boxes.size()) return boxes[shape].name;
  shape -= static_cast<std::uint32_t>(boxes.size());
  if (shape < balls.size()) return balls[shape].name;
  return columns[shape - balls.size()].name;
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
  return std::any_of(scene.boxes.begin(), scene.boxes.end(), inside_box) ||
         std::any_of(scene.balls.begin(), scene.balls.end(), inside_ball) ||
         std::any_of(scene.columns.begin(), scene.columns.end(), inside_column);
}

}  // namespace lacuna::synth
