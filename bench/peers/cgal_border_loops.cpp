// SPDX-License-Identifier: Apache-2.0
// The holes that remain where CGAL's advancing front has reconstructed the surface: its border loops, as a
// text that `lacuna-bench evaluate` reads. A triangle whose circumradius is above the bound is no candidate.
#include "bench/peers/peer.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace {

using namespace lacuna::peers;

namespace fs = std::filesystem;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

using Triangle = std::array<std::size_t, 3>;  // ids of points, all triangles turning the same way
using Loop = std::vector<std::size_t>;

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

using HalfEdge = std::pair<std::size_t, std::size_t>;

// Ends of the half-edges without an opposite one, by their beginnings.
std::map<std::size_t, std::vector<std::size_t>> border_ends(std::span<const Triangle> triangles) {
  std::set<HalfEdge> edges;
  for (const auto& [a, b, c] : triangles) edges.insert({{a, b}, {b, c}, {c, a}});
  std::map<std::size_t, std::vector<std::size_t>> ends;
  for (const auto& [from, to] : edges) {
    if (!edges.contains({to, from})) ends[from].push_back(to);
  }
  return ends;
}

// Returns the border of a mesh as simple loops. The function chains half-edges without an opposite one, and
// cuts a chain where it passes a vertex a second time. It leaves out a chain with an open end, as at
// triangles that do not turn the same way. Cost: O(n log n) for n triangles. The same triangles give the same
// loops.
std::vector<Loop> border_loops(std::span<const Triangle> triangles) {
  std::map<std::size_t, std::vector<std::size_t>> ends = border_ends(triangles);
  std::vector<Loop> loops;
  while (!ends.empty()) {
    Loop chain{ends.begin()->first};
    std::map<std::size_t, std::size_t> place{{chain[0], 0}};  // of each vertex in the chain
    for (auto next = ends.begin(); next != ends.end(); next = ends.find(chain.back())) {
      const std::size_t to = next->second.back();
      next->second.pop_back();
      if (next->second.empty()) ends.erase(next);
      const auto [first, is_new] = place.try_emplace(to, chain.size());
      if (is_new) {
        chain.push_back(to);
        continue;
      }
      const auto begin = chain.begin() + static_cast<std::ptrdiff_t>(first->second);
      loops.emplace_back(begin, chain.end());
      for (const std::size_t id : loops.back()) {
        if (id != to) place.erase(id);
      }
      chain.erase(begin + 1, chain.end());
    }
  }
  return loops;
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
  return run_main(
      argc, argv, 4, 4,
      "SCAN.ply OUT.loops.txt RADIUS FEWEST\n"
      "RADIUS: the largest of a triangle, in units of the scan; FEWEST: points of a loop that is written",
      [&] { run(argv[1], argv[2], std::atof(argv[3]), std::atoi(argv[4])); });
}
