// SPDX-License-Identifier: Apache-2.0
#include "io/lids/relax_edges.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

constexpr int kRounds = 30;

class Swaps {
 public:
  explicit Swaps(LidMesh& mesh) : mesh_(mesh), across_(neighbours(mesh)) {}

  // Whether an edge was swapped.
  bool round() {
    bool is_changed = false;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        if (across_[t][corner] == kNoTriangle || !is_better(t, corner)) continue;
        swap(t, corner);
        is_changed = true;
      }
    }
    return is_changed;
  }

 private:
  // The triangles c a b and d b a on both sides of the edge a b.
  struct Pair {
    std::uint32_t left, right;  // triangles
    std::uint32_t corner, opposite;
    std::uint32_t a, b, c, d;
  };

  Pair pair(std::uint32_t t, std::uint32_t corner) const {
    const LidTriangle& left = mesh_.triangles[t];
    const std::uint32_t u = across_[t][corner];
    const LidTriangle& right = mesh_.triangles[u];
    const std::uint32_t a = left[(corner + 1) % 3], b = left[(corner + 2) % 3];
    std::uint32_t opposite = 0;
    while (right[opposite] == a || right[opposite] == b) ++opposite;
    return {t, u, corner, opposite, a, b, left[corner], right[opposite]};
  }

  bool is_better(std::uint32_t t, std::uint32_t corner) const {
    const Pair p = pair(t, corner);
    const Eigen::Vector3d &a = mesh_.vertices[p.a], &b = mesh_.vertices[p.b];
    const Eigen::Vector3d &c = mesh_.vertices[p.c], &d = mesh_.vertices[p.d];
    // The sum of the cotangents of the angles at c and d, times both sines: negative beyond half a turn.
    const double dot_c = (a - c).dot(b - c), dot_d = (a - d).dot(b - d);
    const Eigen::Vector3d left = (a - c).cross(b - c), right = (b - d).cross(a - d);
    const double sum = dot_c * right.norm() + dot_d * left.norm();
    const double size = (std::abs(dot_c) + left.norm()) * (std::abs(dot_d) + right.norm());
    constexpr double kTie = 1e-9;
    return sum < -kTie * size && !is_edge(p);
  }

  // Whether c d exists: the triangles around c are passed in both directions.
  bool is_edge(const Pair& p) const {
    for (const std::uint32_t side : {1u, 2u}) {
      std::uint32_t t = p.left, corner = p.corner;
      do {
        t = across_[t][(corner + side) % 3];
        if (t == kNoTriangle) break;
        const LidTriangle& triangle = mesh_.triangles[t];
        corner = 0;
        while (triangle[corner] != p.c) ++corner;
        if (std::find(triangle.begin(), triangle.end(), p.d) != triangle.end()) return true;
      } while (t != p.left);
    }
    return false;
  }

  // c a b and d b a become c d b and c a d.
  void swap(std::uint32_t t, std::uint32_t corner) {
    const Pair p = pair(t, corner);
    const std::uint32_t beyond_bc = across_[p.left][(p.corner + 1) % 3];
    const std::uint32_t beyond_ca = across_[p.left][(p.corner + 2) % 3];
    const auto right_beyond = [&](std::uint32_t vertex) {  // across the edge without it
      const LidTriangle& right = mesh_.triangles[p.right];
      std::uint32_t i = 0;
      while (right[i] != vertex) ++i;
      return across_[p.right][i];
    };
    const std::uint32_t beyond_ad = right_beyond(p.b), beyond_db = right_beyond(p.a);
    mesh_.triangles[p.left] = {p.c, p.d, p.b};
    mesh_.triangles[p.right] = {p.c, p.a, p.d};
    across_[p.left] = {beyond_db, beyond_bc, p.right};
    across_[p.right] = {beyond_ad, p.left, beyond_ca};
    replace(beyond_db, p.right, p.left);
    replace(beyond_ca, p.left, p.right);
  }

  void replace(std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
    if (triangle == kNoTriangle) return;
    for (std::uint32_t& neighbour : across_[triangle]) {
      if (neighbour == from) {
        neighbour = to;
        return;
      }
    }
  }

  LidMesh& mesh_;
  LidNeighbours across_;
};

}  // namespace

void relax_edges(LidMesh& mesh) {
  Swaps swaps(mesh);
  for (int i = 0; i < kRounds && swaps.round(); ++i) {
  }
}

}  // namespace lacuna::io
