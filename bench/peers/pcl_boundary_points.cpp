// SPDX-License-Identifier: Apache-2.0
// The boundary points that the Point Cloud Library flags, as a result that `lacuna-bench evaluate` reads.
#include "bench/peers/pcl_steps.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <thread>

namespace {

using namespace lacuna::peers;

namespace fs = std::filesystem;

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

void run(const char* scan, const fs::path& folder, int neighbours, double degrees) {
  if (neighbours < 3 || !(degrees > 0 && degrees <= 360)) {
    throw std::runtime_error("NEIGHBOURS must be 3 or more, DEGREES above 0 and at most 360");
  }
  const Cloud::Ptr cloud = load_cloud(scan);
  const Tree::Ptr tree(new Tree);
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  const Normals::Ptr normals = estimate_normals(cloud, tree, neighbours, threads);
  const auto angle = static_cast<float>(degrees * std::numbers::pi / 180);
  const Boundary boundary = find_boundary(cloud, normals, tree, neighbours, angle);
  fs::create_directories(folder);
  write_no_loops(folder / "loops.ply");
  write_boundary(folder / "boundary.ply", *cloud, boundary);
  std::printf("points %zu\n", cloud->size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: %s SCAN.ply OUT_FOLDER NEIGHBOURS DEGREES\n", argv[0]);
    return 2;
  }
  try {
    run(argv[1], argv[2], std::atoi(argv[3]), std::atof(argv[4]));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
