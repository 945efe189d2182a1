// SPDX-License-Identifier: Apache-2.0
// Makes the points of a plane with a round hole, finds the hole, and prints it.
#include <cmath>
#include <cstdio>
#include <vector>

#include <lacuna/lacuna.hpp>

namespace {

// A square of 100 x 100 points, one unit apart and a little off their grid, without those within `radius` of
// the middle.
std::vector<Eigen::Vector3d> punched_plane(double radius) {
  std::vector<Eigen::Vector3d> points;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      const Eigen::Vector3d point(x + 0.2 * std::sin(7.0 * x + 3.0 * y),
                                  y + 0.2 * std::cos(5.0 * x - 2.0 * y), 0);
      if ((point - Eigen::Vector3d(50, 50, 0)).norm() > radius) points.push_back(point);
    }
  }
  return points;
}

}  // namespace

int main() {
  try {
    lacuna::Config config;
    config.scale.min_hole = 10;          // as --min-hole 10
    config.selection.holes_only = true;  // without the outer boundary of the square
    const lacuna::Holes found = lacuna::find_holes(punched_plane(12), config);
    for (const lacuna::ReportedLoop& loop : found.loops) {
      const lacuna::LoopMeasures& hole = loop.measures;
      std::printf("hole at %.1f %.1f %.1f: %zu points, perimeter %.1f, diameter %.1f, confidence %.2f\n",
                  hole.centroid.x(), hole.centroid.y(), hole.centroid.z(), loop.points.size(), hole.perimeter,
                  hole.diameter, hole.track.confidence);
    }
  } catch (const lacuna::Error& error) {
    std::fprintf(stderr, "find_holes: %s\n", error.what());
    return 1;
  }
}
