// Boundary points as the Point Cloud Library finds them: normals on all threads, then BoundaryEstimation,
// which knows one thread only. One tree serves both. PCL counts a point among its own neighbours.
#include "bench/peers/peer.hpp"
#include "bench/peers/read_ply.hpp"

#include <omp.h>
#include <pcl/features/boundary.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace {

using namespace lacuna::peers;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

Cloud::Ptr load(const char* file) {
  const std::vector<float> coordinates = read_ply(file);
  const Cloud::Ptr cloud(new Cloud);
  cloud->reserve(coordinates.size() / 3);
  for (std::size_t i = 0; i < coordinates.size(); i += 3) {
    cloud->emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  }
  return cloud;
}

Result run(const Arguments& arguments) {
  omp_set_num_threads(arguments.threads);
  Clock clock;
  Result result;
  const Cloud::Ptr cloud = load(arguments.scan);
  result.points = cloud->size();
  result.load = clock.lap();

  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  const Normals::Ptr normals(new Normals);
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(static_cast<unsigned>(arguments.threads));
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(tree);
  estimation.setKSearch(arguments.neighbours);
  estimation.compute(*normals);
  result.normals = clock.lap();

  pcl::PointCloud<pcl::Boundary> boundary;
  pcl::BoundaryEstimation<pcl::PointXYZ, pcl::Normal, pcl::Boundary> detection;
  detection.setInputCloud(cloud);
  detection.setInputNormals(normals);
  detection.setSearchMethod(tree);
  detection.setKSearch(arguments.neighbours);
  detection.compute(boundary);
  for (const pcl::Boundary& point : boundary) result.boundary_points += point.boundary_point;
  result.boundary = clock.lap();
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return run_peer(argc, argv, run);
}
