// SPDX-License-Identifier: Apache-2.0
// Decides whether the surface of a scan blocks a ray, by voxels with points.
#pragma once

#include <memory>
#include <span>

#include <Eigen/Geometry>

namespace lacuna::io {

class Obstacles {
 public:
  // `voxel`: its edge, above 0. Memory: a few bytes for each voxel with points.
  Obstacles(std::span<const Eigen::Vector3d> points, double voxel);
  ~Obstacles();

  // Whether a voxel with points lies on the line from `eye` to `place`. The voxels around both ends do not
  // count: up to two voxels from the place, and one from the eye. Cost: the voxels on the line.
  bool block(const Eigen::Vector3d& eye, const Eigen::Vector3d& place) const;
  bool touch(const Eigen::AlignedBox3d& box) const;  // whether a voxel in the box has points

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
  Eigen::Vector3d origin_{0, 0, 0};  // near the points, which may be far from 0 0 0
  double voxel_;
};

}  // namespace lacuna::io
