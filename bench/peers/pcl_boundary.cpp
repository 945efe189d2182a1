// SPDX-License-Identifier: Apache-2.0
// Finds boundary points with the Point Cloud Library: normals on all threads, then BoundaryEstimation, which
// runs on one thread only. One tree serves both. PCL counts a point among its own neighbours. The points can
// be written as a result that `lacuna-bench evaluate` reads.
#include "bench/peers/peer.hpp"

#include <filesystem>
#include <fstream>
#include <numbers>

#include <omp.h>
#include <pcl/features/boundary.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace {

using namespace lacuna::peers;
namespace fs = std::filesystem;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Boundary = pcl::PointCloud<pcl::Boundary>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

// Returns the points of a PLY file with finite coordinates.
Cloud::Ptr load_cloud(const char* file) {
  const std::vector<float> coordinates = read_scan(file);
  const Cloud::Ptr cloud(new Cloud);
  cloud->reserve(coordinates.size() / 3);
  for (std::size_t i = 0; i < coordinates.size(); i += 3) {
    cloud->emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  }
  return cloud;
}

// Both functions search with the same tree, which the first of them builds. PCL counts a point among its own
// neighbours.
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

// A boundary point has a gap of more than `angle` (radians) between the directions of its neighbours. It runs
// on one thread, because PCL has no other way.
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

constexpr const char* kVertices =
    "\nproperty float x\nproperty float y\nproperty float z\nproperty uint scalar_id\n";

std::ofstream create(const fs::path& file) {
  std::ofstream out(file);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out.precision(9);
  return out;
}

void write_boundary(const fs::path& file, const Cloud& cloud, const Boundary& boundary) {
  std::size_t count = 0;
  for (const pcl::Boundary& point : boundary) count += point.boundary_point;
  std::ofstream out = create(file);
  out << "ply\nformat ascii 1.0\nelement vertex " << count << kVertices << "end_header\n";
  for (std::size_t id = 0; id < boundary.size(); ++id) {
    if (!boundary[id].boundary_point) continue;
    out << cloud[id].x << ' ' << cloud[id].y << ' ' << cloud[id].z << ' ' << id << '\n';
  }
}

// PCL finds no loops.
void write_no_loops(const fs::path& file) {
  create(file) << "ply\nformat ascii 1.0\nelement vertex 0" << kVertices
               << "property int scalar_loop\nend_header\n";
}

Result run(const Arguments& arguments) {
  Clock clock;
  Result result;
  const Cloud::Ptr cloud = load_cloud(arguments.scan);
  result.points = cloud->size();
  result.load = clock.lap();

  const Tree::Ptr tree(new Tree);
  const Normals::Ptr normals = estimate_normals(cloud, tree, arguments.neighbours, arguments.threads);
  result.normals = clock.lap();

  const auto angle = static_cast<float>(arguments.degrees * std::numbers::pi / 180);
  const Boundary boundary = find_boundary(cloud, normals, tree, arguments.neighbours, angle);
  for (const pcl::Boundary& point : boundary) result.boundary_points += point.boundary_point;
  result.boundary = clock.lap();
  if (arguments.out) {
    fs::create_directories(arguments.out);
    write_no_loops(fs::path(arguments.out) / "loops.ply");
    write_boundary(fs::path(arguments.out) / "boundary.ply", *cloud, boundary);
    result.untimed = clock.lap();
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return run_peer(argc, argv, run);
}
