// SPDX-License-Identifier: Apache-2.0
// A cloud of PCL in, each hole out as indices of its points, in their order.
#include "plane_with_hole.hpp"

#include <lacuna/lacuna.hpp>
#include <pcl/common/centroid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/PointIndices.h>

// Reads the coordinates where they are, in records of 16 bytes.
lacuna::Holes find_holes(const pcl::PointCloud<pcl::PointXYZ>& cloud, const lacuna::Config& config) {
  const float* const first = cloud.empty() ? nullptr : &cloud.front().x;
  return lacuna::find_holes(lacuna::PointArray(first, cloud.size(), sizeof(pcl::PointXYZ)), config);
}

// PCL's functions take them together with the cloud. `pcl::PointCloud(cloud, hole.indices)` is a cloud of
// them.
pcl::PointIndices indices_of(const lacuna::ReportedLoop& loop) {
  pcl::PointIndices hole;
  for (const lacuna::LoopPoint& point : loop.points) hole.indices.push_back(value(point.id));
  return hole;
}

int main() {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (const Eigen::Vector3d& p : plane_with_hole()) cloud.emplace_back(p.x(), p.y(), p.z());

  lacuna::Config config;
  config.scale.min_hole = 10;
  config.selection.holes_only = true;
  for (const lacuna::ReportedLoop& loop : find_holes(cloud, config).loops) {
    const pcl::PointCloud<pcl::PointXYZ> hole(cloud, indices_of(loop).indices);
    print_hole(loop.measures, hole.size());
  }
}
