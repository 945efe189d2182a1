// SPDX-License-Identifier: Apache-2.0
// A cloud of Open3D in, the holes out as a set of lines.
#include "plane_with_hole.hpp"

#include <lacuna/lacuna.hpp>
#include <open3d/geometry/LineSet.h>
#include <open3d/geometry/PointCloud.h>

open3d::geometry::LineSet lines_of(const lacuna::Holes& found) {
  open3d::geometry::LineSet lines;
  for (const lacuna::ReportedLoop& loop : found.loops) {
    const int first = static_cast<int>(lines.points_.size()), size = static_cast<int>(loop.points.size());
    for (int i = 0; i < size; ++i) {
      lines.points_.push_back(loop.points[i].position());
      lines.lines_.emplace_back(first + i, first + (i + 1) % size);
    }
  }
  return lines;
}

int main() {
  const open3d::geometry::PointCloud cloud(plane_with_hole());

  lacuna::Config config;
  config.scale.min_hole = 10;
  config.selection.holes_only = true;
  const lacuna::Holes found = lacuna::find_holes(cloud.points_, config);
  print_hole(found.loops.at(0).measures, lines_of(found).lines_.size());
}
