// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/section.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// Keeps the values of the given rows, in order.
template <class Value>
void keep(std::vector<Value>& values, const std::vector<std::size_t>& rows) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < rows.size(); ++i) values[i] = values[rows[i]];
  values.resize(rows.size());
}

void hide_points_above(float height, Scene::Points& points) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < points.positions.size(); ++i)
    if (points.positions[i].z() <= height) shown.push_back(i);
  keep(points.positions, shown);
  keep(points.probabilities, shown);
  keep(points.normals, shown);
  keep(points.colours, shown);
}

void hide_loops_above(float height, Scene::Loops& loops) {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::size_t> first = {0};
  for (std::size_t loop = 0; loop < loops.ids.size(); ++loop) {
    const std::span<const Eigen::Vector3f> all = loops.vertices_of(loop);
    if (std::ranges::any_of(all, [&](const Eigen::Vector3f& v) { return v.z() <= height; }))
      vertices.insert(vertices.end(), all.begin(), all.end());
    first.push_back(vertices.size());
  }
  loops.vertices = std::move(vertices);
  loops.first = std::move(first);
}

}  // namespace

void hide_above(Scene& scene, double height) {
  const auto relative = static_cast<float>(height - scene.origin.z());
  hide_points_above(relative, scene.points);
  hide_loops_above(relative, scene.loops);
}

}  // namespace lacuna::io
