// SPDX-License-Identifier: Apache-2.0
// Finds boundary points with Open3D, by its tensor interface on the CPU. Normals come from the nearest
// neighbours. ComputeBoundaryPoints then takes a radius, and uses the nearest neighbours within it. The
// radius is the median distance of the last neighbour, so that half of the points have all of their
// neighbours. Finding the radius is not timed.
#include "bench/peers/peer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <omp.h>
#include <open3d/core/nns/NearestNeighborSearch.h>
#include <open3d/t/geometry/PointCloud.h>
#include <tbb/global_control.h>

namespace {

using namespace lacuna::peers;
using open3d::core::Tensor;
using open3d::t::geometry::PointCloud;

Tensor load(const char* file) {
  const std::vector<float> coordinates = read_scan(file);
  Tensor positions({static_cast<std::int64_t>(coordinates.size() / 3), 3}, open3d::core::Float32);
  std::memcpy(positions.GetDataPtr(), coordinates.data(), coordinates.size() * sizeof(float));
  return positions;
}

double median_reach(const Tensor& positions, int neighbours) {
  constexpr std::int64_t kQueries = 1000;
  const std::int64_t points = positions.GetLength();
  const std::int64_t step = std::max<std::int64_t>(points / kQueries, 1);
  open3d::core::nns::NearestNeighborSearch search(positions);
  search.KnnIndex();
  const Tensor queries = positions.Slice(0, 0, points, step).Contiguous();
  const Tensor squared = search.KnnSearch(queries, neighbours).second.Contiguous();
  const std::int64_t found = squared.GetShape(1);
  std::vector<float> reach;
  for (std::int64_t i = 0; i < squared.GetLength(); ++i) {
    reach.push_back(std::sqrt(squared.GetDataPtr<float>()[(i + 1) * found - 1]));
  }
  const auto middle = reach.begin() + static_cast<std::ptrdiff_t>(reach.size() / 2);
  std::nth_element(reach.begin(), middle, reach.end());
  return *middle;
}

Result run(const Arguments& arguments) {
  // The search runs in TBB, the rest in OpenMP.
  omp_set_num_threads(arguments.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(arguments.threads));
  Clock clock;
  Result result;
  PointCloud cloud(load(arguments.scan));
  result.points = static_cast<std::size_t>(cloud.GetPointPositions().GetLength());
  result.load = clock.lap();

  cloud.EstimateNormals(arguments.neighbours);
  result.normals = clock.lap();

  const double radius = median_reach(cloud.GetPointPositions(), arguments.neighbours);
  result.untimed = clock.lap();
  const Tensor mask = std::get<1>(cloud.ComputeBoundaryPoints(radius, arguments.neighbours));
  result.boundary = clock.lap();
  result.boundary_points =
      static_cast<std::size_t>(mask.To(open3d::core::Int64).Sum({0}).Item<std::int64_t>());
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return run_peer(argc, argv, run);
}
