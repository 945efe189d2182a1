// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna::synth {

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
