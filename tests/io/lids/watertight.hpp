// SPDX-License-Identifier: Apache-2.0
// Whether the triangles of a lid are a disc on its loop.
#pragma once

#include "io/lids/lid_mesh.hpp"

#include <map>
#include <set>
#include <utility>

namespace lacuna::test {

// Each edge of the loop is on one triangle, in its direction. Each other edge is on two, once in each
// direction. All vertices are used, and the surface is a disc.
inline bool is_disc_on_loop(const io::LidMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  std::set<std::uint32_t> used;
  for (const io::LidTriangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      used.insert(triangle[i]);
      ++directed[{triangle[i], triangle[(i + 1) % 3]}];
    }
  }
  const auto n = static_cast<std::uint32_t>(mesh.loop_points);
  std::size_t edges = 0;
  for (const auto& [edge, count] : directed) {
    const auto [a, b] = edge;
    const bool is_loop_edge = a < n && b == (a + 1) % n;
    const bool has_reverse = directed.count({b, a}) == 1;
    if (count != 1 || has_reverse == is_loop_edge) return false;
    if (is_loop_edge || a < b) ++edges;
  }
  for (std::uint32_t a = 0; a < n; ++a) {
    if (directed.count({a, (a + 1) % n}) == 0) return false;
  }
  const std::size_t vertices = mesh.vertices.size(), faces = mesh.triangles.size();
  return used.size() == vertices && *used.rbegin() + 1 == vertices && vertices + faces == edges + 1;
}

// Likewise, a lid with islands is a sphere without so many discs, one for the loop and each island. All of
// its edges on one triangle are between points of loops, and each such point has one that leaves it.
inline bool is_surface_on_loops(const io::LidMesh& mesh, std::size_t loops) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  std::set<std::uint32_t> used;
  for (const io::LidTriangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      used.insert(triangle[i]);
      if (!directed.insert({triangle[i], triangle[(i + 1) % 3]}).second) return false;
    }
  }
  std::set<std::uint32_t> left;
  std::size_t edges = 0;
  for (const auto& [a, b] : directed) {
    const bool is_of_loop = directed.count({b, a}) == 0;
    if (is_of_loop && (a >= mesh.loop_points || b >= mesh.loop_points || !left.insert(a).second))
      return false;
    if (is_of_loop || a < b) ++edges;
  }
  const std::size_t vertices = mesh.vertices.size(), faces = mesh.triangles.size();
  return left.size() == mesh.loop_points && used.size() == vertices && vertices + faces + loops == edges + 2;
}

}  // namespace lacuna::test
