// SPDX-License-Identifier: Apache-2.0
// Finds boundary points with the Point Cloud Library: normals on all threads, then BoundaryEstimation, which
// runs on one thread only. One tree serves both. PCL counts a point among its own neighbours.
#include "bench/peers/pcl_steps.hpp"
#include "bench/peers/peer.hpp"

#include <numbers>

namespace {

using namespace lacuna::peers;

constexpr auto kAngle = static_cast<float>(std::numbers::pi / 2);  // PCL's own default

Result run(const Arguments& arguments) {
  Clock clock;
  Result result;
  const Cloud::Ptr cloud = load_cloud(arguments.scan);
  result.points = cloud->size();
  result.load = clock.lap();

  const Tree::Ptr tree(new Tree);
  const Normals::Ptr normals = estimate_normals(cloud, tree, arguments.neighbours, arguments.threads);
  result.normals = clock.lap();

  const Boundary boundary = find_boundary(cloud, normals, tree, arguments.neighbours, kAngle);
  for (const pcl::Boundary& point : boundary) result.boundary_points += point.boundary_point;
  result.boundary = clock.lap();
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return run_peer(argc, argv, run);
}
