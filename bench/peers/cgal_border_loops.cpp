// SPDX-License-Identifier: Apache-2.0
// The holes that remain where CGAL's advancing front has reconstructed the surface: its border loops, as a
// text that `lacuna-bench evaluate` reads. A triangle whose circumradius is above the bound is no candidate.
#include "bench/peers/border_loops.hpp"
#include "bench/peers/read_scan.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace {

using namespace lacuna::peers;

namespace fs = std::filesystem;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

struct BoundedRadius {
  double bound;

  // Smaller values first; facets of infinity never.
  template <class Front, class Cell>
  double operator()(const Front& front, const Cell& cell, int facet) const {
    const double priority = front.smallest_radius_delaunay_sphere(cell, facet);
    if (priority == front.infinity()) return priority;
    const auto corner = [&](int turn) { return cell->vertex((facet + turn) % 4)->point(); };
    const double square = CGAL::squared_radius(corner(1), corner(2), corner(3));
    return square <= bound * bound ? priority : front.infinity();
  }
};

std::vector<Point> load_points(const char* file) {
  const std::vector<float> coordinates = read_scan(file);
  std::vector<Point> points;
  points.reserve(coordinates.size() / 3);
  for (std::size_t i = 0; i < coordinates.size(); i += 3) {
    points.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  }
  return points;
}

void write_loops(const fs::path& file, const std::vector<Loop>& loops, std::size_t fewest) {
  fs::path partial = file;
  partial += ".partial";
  std::ofstream out(partial);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out << "# one border loop per line, 0-based point ids\n";
  for (const Loop& loop : loops) {
    if (loop.size() < fewest) continue;
    for (const std::size_t id : loop) out << id << ' ';
    out << '\n';
  }
  out.close();
  fs::rename(partial, file);
}

void run(const char* scan, const fs::path& file, double radius, int fewest) {
  if (!(radius > 0)) throw std::runtime_error("RADIUS must be above 0");
  if (fewest < 3) throw std::runtime_error("FEWEST must be 3 or more");
  const std::vector<Point> points = load_points(scan);
  std::vector<Triangle> triangles;
  CGAL::advancing_front_surface_reconstruction(points.begin(), points.end(), std::back_inserter(triangles),
                                               BoundedRadius{radius});
  const std::vector<Loop> loops = border_loops(triangles);
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  write_loops(file, loops, static_cast<std::size_t>(fewest));
  std::printf("points %zu\ntriangles %zu\nborder loops %zu\n", points.size(), triangles.size(), loops.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(
        stderr,
        "usage: %s SCAN.ply OUT.loops.txt RADIUS FEWEST\n"
        "RADIUS: the largest of a triangle, in units of the scan; FEWEST: points of a loop that is written\n",
        argv[0]);
    return 2;
  }
  try {
    run(argv[1], argv[2], std::atof(argv[3]), std::atoi(argv[4]));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
