// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/obstacles.hpp"

#include "engine/store/openvdb.hpp"

#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>

namespace lacuna::io {
namespace {

openvdb::Vec3d vec3(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

openvdb::Coord voxel_of(const Eigen::Vector3d& place) {
  return openvdb::Coord::floor(vec3(place));
}

}  // namespace

struct Obstacles::Grid {
  openvdb::MaskTree tree;
};

Obstacles::Obstacles(std::span<const Eigen::Vector3d> points, double voxel)
    : grid_(std::make_unique<Grid>()), voxel_(voxel) {
  if (!points.empty()) origin_ = points.front();
  openvdb::tree::ValueAccessor<openvdb::MaskTree> voxels(grid_->tree);
  for (const Eigen::Vector3d& point : points) voxels.setValueOn(voxel_of((point - origin_) / voxel_));
}

Obstacles::~Obstacles() = default;

bool Obstacles::block(const Eigen::Vector3d& eye, const Eigen::Vector3d& place) const {
  const Eigen::Vector3d from = (eye - origin_) / voxel_, arm = (place - eye) / voxel_;
  const double length = arm.norm();
  constexpr double kAtEye = 1, kAtPlace = 2;
  if (!(length > kAtEye + kAtPlace)) return false;
  using Ray = openvdb::math::Ray<double>;
  openvdb::math::DDA<Ray, 0> line(Ray(vec3(from), vec3(arm / length), kAtEye, length - kAtPlace));
  const openvdb::tree::ValueAccessor<const openvdb::MaskTree> voxels(grid_->tree);
  do {
    if (voxels.isValueOn(line.voxel())) return true;
  } while (line.step());
  return false;
}

bool Obstacles::touch(const Eigen::AlignedBox3d& box) const {
  const openvdb::CoordBBox voxels(voxel_of((box.min() - origin_) / voxel_),
                                  voxel_of((box.max() - origin_) / voxel_));
  for (auto at = voxels.begin(); at; ++at)
    if (grid_->tree.isValueOn(*at)) return true;
  return false;
}

}  // namespace lacuna::io
