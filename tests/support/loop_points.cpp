// SPDX-License-Identifier: Apache-2.0
#include "tests/support/loop_points.hpp"

#include "engine/loops/measure_loops.hpp"

namespace lacuna::test {

DrawnLoop square(double half, LoopKind kind, const Eigen::Vector3d& centre, int on_side) {
  DrawnLoop loop{.points = {}, .kind = kind};
  const std::vector<Eigen::Vector3d> corners = {
      {-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (int k = 0; k < on_side; ++k)
      loop.points.push_back(centre + corners[i] + (corners[(i + 1) % 4] - corners[i]) * k / on_side);
  }
  return loop;
}

MeasuredLoops measured(std::span<const DrawnLoop> drawn, const std::filesystem::path& folder) {
  MeasuredLoops loops;
  Loops& level = loops.loops.levels.emplace_back(folder / "loops");
  std::uint64_t id = 0;
  for (const DrawnLoop& loop : drawn) {
    Loop points;
    for (const Eigen::Vector3d& at : loop.points) points.push_back(loop_point(id++, at));
    level.add(points.size(), {}, [&](std::uint64_t i) { return points[i]; });
    loops.loops.chosen.push_back({0, static_cast<std::uint32_t>(loops.measures.size())});
    loops.measures.push_back(measure_loop(points, 1));
    loops.measures.back().kind = loop.kind;
  }
  return loops;
}

}  // namespace lacuna::test
