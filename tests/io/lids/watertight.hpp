// SPDX-License-Identifier: Apache-2.0
// Whether the triangles of a lid are a surface on its loops.
#pragma once

#include "io/explain/lids/make_lid.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {

// A lid is a sphere without so many discs, one for the loop and each island. Each of its edges on one
// triangle is between points of loops, and each such point has one that leaves it. All vertices are used.
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
    if (is_of_loop && !left.insert(a).second) return false;
    // Points of one loop are in its order.
    if (is_of_loop && loops == 1 && b != (a + 1) % mesh.vertices.size()) return false;
    if (is_of_loop || a < b) ++edges;
  }
  const std::size_t vertices = mesh.vertices.size(), faces = mesh.triangles.size();
  return left.size() == mesh.vertices.size() && used.size() == vertices && *used.rbegin() + 1 == vertices &&
         vertices + faces + loops == edges + 2;
}

inline bool is_disc_on_loop(const io::LidMesh& mesh) {
  return is_surface_on_loops(mesh, 1);
}

}  // namespace lacuna::test
