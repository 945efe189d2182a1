// SPDX-License-Identifier: Apache-2.0
#include "engine/run/parallel.hpp"
#include "engine/store/openvdb.hpp"
#include "io/explain/stations/find_causes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

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

namespace {

constexpr double kLeastGain = 0.01;  // of the hidden area, for one more station
constexpr std::size_t kMostEyes = 500;

bool sees(const Eigen::Vector3d& eye, const InnerSample& place, const Obstacles& obstacles,
          const SightLimits& limits) {
  const Eigen::Vector3d arm = place.position - eye;
  const double range = arm.norm();
  return range > 0 && range <= limits.range &&
         std::fabs(arm.dot(place.normal)) >= limits.least_cosine * range &&
         !obstacles.block(eye, place.position);
}

using Cell = std::pair<std::int64_t, std::int64_t>;  // y and x

// Returns the lowest level point of each square of the grid.
std::map<Cell, Eigen::Vector3d> lowest_points(std::span<const Eigen::Vector3d> points,
                                              std::span<const Eigen::Vector3f> normals, double grid) {
  std::map<Cell, Eigen::Vector3d> lowest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::fabs(normals[i].z()) < kLevelFloor) continue;
    const Cell cell{static_cast<std::int64_t>(std::floor(points[i].y() / grid)),
                    static_cast<std::int64_t>(std::floor(points[i].x() / grid))};
    const auto [at, is_new] = lowest.emplace(cell, points[i]);
    if (!is_new && points[i].z() < at->second.z()) at->second = points[i];
  }
  return lowest;
}

// A table is higher than the floor around it.
std::vector<Eigen::Vector3d> floor_places(const std::map<Cell, Eigen::Vector3d>& lowest, double grid,
                                          double height) {
  const auto reach = static_cast<std::int64_t>(std::ceil(height / grid));
  std::vector<Eigen::Vector3d> places;
  for (const auto& [cell, place] : lowest) {
    double floor = place.z();
    for (std::int64_t y = cell.first - reach; y <= cell.first + reach; ++y) {
      const auto end = lowest.upper_bound({y, cell.second + reach});
      for (auto at = lowest.lower_bound({y, cell.second - reach}); at != end; ++at)
        floor = std::min(floor, at->second.z());
    }
    if (place.z() <= floor + 0.2 * height) places.push_back(place);
  }
  return places;
}

}  // namespace

std::vector<Eigen::Vector3d> eyes_over_floor(std::span<const Eigen::Vector3d> points,
                                             std::span<const Eigen::Vector3f> normals,
                                             const Obstacles& obstacles, const FloorLimits& limits) {
  double grid = limits.grid > 0 ? limits.grid : limits.height / 2;
  for (;; grid *= std::sqrt(2)) {
    std::vector<Eigen::Vector3d> eyes;
    for (const Eigen::Vector3d& place :
         floor_places(lowest_points(points, normals, grid), grid, limits.height)) {
      const Eigen::Vector3d side(limits.clearance, limits.clearance, 0);
      const Eigen::Vector3d low(place.x(), place.y(), place.z() + kFreeFrom * limits.height),
          eye(place.x(), place.y(), place.z() + limits.height);
      if (!obstacles.touch({low - side, eye + side})) eyes.push_back(eye);
    }
    if (limits.grid > 0 || eyes.size() <= kMostEyes) return eyes;
  }
}

std::vector<NextStation> choose_stations(std::span<const InnerSample> hidden,
                                         std::span<const Eigen::Vector3d> eyes, const Obstacles& obstacles,
                                         const SightLimits& limits, std::size_t most) {
  std::vector<std::vector<bool>> seen(eyes.size());
  for_each_here(eyes.size(), [&](std::size_t eye) {
    seen[eye].resize(hidden.size());
    for (std::size_t i = 0; i < hidden.size(); ++i)
      seen[eye][i] = sees(eyes[eye], hidden[i], obstacles, limits);
  });
  std::vector<double> left;  // of each hidden place
  for (const InnerSample& place : hidden) left.push_back(place.area);
  const double all = std::accumulate(left.begin(), left.end(), 0.0);
  std::vector<NextStation> chosen;
  while (chosen.size() < most) {
    std::size_t best = 0;
    double most_area = 0;
    for (std::size_t eye = 0; eye < eyes.size(); ++eye) {
      double area = 0;
      for (std::size_t i = 0; i < hidden.size(); ++i) area += seen[eye][i] ? left[i] : 0;
      if (area > most_area) best = eye, most_area = area;
    }
    if (!(most_area > kLeastGain * all)) break;
    chosen.push_back({best, eyes[best], most_area});
    for (std::size_t i = 0; i < hidden.size(); ++i)
      if (seen[best][i]) left[i] = 0;
  }
  return chosen;
}

}  // namespace lacuna::io
