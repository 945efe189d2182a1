// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/pcl_steps.hpp"

#include "bench/peers/read_scan.hpp"

#include <omp.h>
#include <pcl/features/boundary.h>
#include <pcl/features/normal_3d_omp.h>

namespace lacuna::peers {

Cloud::Ptr load_cloud(const char* file) {
  const std::vector<float> coordinates = read_scan(file);
  const Cloud::Ptr cloud(new Cloud);
  cloud->reserve(coordinates.size() / 3);
  for (std::size_t i = 0; i < coordinates.size(); i += 3) {
    cloud->emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  }
  return cloud;
}

Normals::Ptr estimate_normals(const Cloud::Ptr& cloud, const Tree::Ptr& tree, int neighbours, int threads) {
  omp_set_num_threads(threads);
  const Normals::Ptr normals(new Normals);
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(static_cast<unsigned>(threads));
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(tree);
  estimation.setKSearch(neighbours);
  estimation.compute(*normals);
  return normals;
}

Boundary find_boundary(const Cloud::Ptr& cloud, const Normals::Ptr& normals, const Tree::Ptr& tree,
                       int neighbours, float angle) {
  Boundary boundary;
  pcl::BoundaryEstimation<pcl::PointXYZ, pcl::Normal, pcl::Boundary> detection;
  detection.setInputCloud(cloud);
  detection.setInputNormals(normals);
  detection.setSearchMethod(tree);
  detection.setKSearch(neighbours);
  detection.setAngleThreshold(angle);
  detection.compute(boundary);
  return boundary;
}

}  // namespace lacuna::peers
