// SPDX-License-Identifier: Apache-2.0
#include "io/lids/refine.hpp"

#include "io/lids/relax_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacuna::io {
namespace {

std::vector<double> loop_spacing(const LidMesh& mesh) {
  const std::size_t n = mesh.loop_points;
  const std::vector<std::uint32_t> next = next_on_loops(mesh);
  std::vector<double> spacing(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double half = (mesh.vertices[next[i]] - mesh.vertices[i]).norm() / 2;
    spacing[i] += half;
    spacing[next[i]] += half;
  }
  return spacing;
}

double mean_spacing(const std::vector<double>& spacing, const LidTriangle& triangle) {
  return (spacing[triangle[0]] + spacing[triangle[1]] + spacing[triangle[2]]) / 3;
}

// Returns the factor that makes the number of vertices fit: 1 if it fits already. An equilateral lattice of
// edge s has a vertex for each s^2 sqrt(3) / 2.
double coarsening(const LidMesh& mesh, const std::vector<double>& spacing) {
  double vertices = 0;
  for (const LidTriangle& triangle : mesh.triangles) {
    const double s = mean_spacing(spacing, triangle);
    if (s > 0) vertices += area_vector(mesh, triangle).norm() / (s * s * std::numbers::sqrt3 / 2);
  }
  return std::max(1.0, std::sqrt(vertices / kMostInnerVertices));
}

// Decides by Liepa's condition, with his factor sqrt(2).
bool is_too_large(const LidMesh& mesh, const std::vector<double>& spacing, const LidTriangle& triangle,
                  const Eigen::Vector3d& centroid, double at_centroid) {
  for (const std::uint32_t corner : triangle) {
    const double reach = std::numbers::sqrt2 * (centroid - mesh.vertices[corner]).norm();
    if (reach <= at_centroid || reach <= spacing[corner]) return false;
  }
  return true;
}

// Whether the lid has as few inner vertices as it may.
bool refine_to(LidMesh& mesh, std::vector<double> spacing) {
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    const std::size_t triangles = mesh.triangles.size();
    for (std::size_t t = 0; t < triangles; ++t) {
      const LidTriangle triangle = mesh.triangles[t];
      const auto [a, b, c] = triangle;
      const Eigen::Vector3d centroid = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
      const double at_centroid = mean_spacing(spacing, triangle);
      if (!is_too_large(mesh, spacing, triangle, centroid, at_centroid)) continue;
      if (mesh.vertices.size() - mesh.loop_points == kMostInnerVertices) return false;
      const auto added = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(centroid);
      spacing.push_back(at_centroid);
      mesh.triangles[t] = {a, b, added};
      mesh.triangles.push_back({b, c, added});
      mesh.triangles.push_back({c, a, added});
      is_changed = true;
    }
    if (is_changed) relax_edges(mesh);
  }
  return true;
}

}  // namespace

void refine(LidMesh& mesh) {
  std::vector<double> spacing = loop_spacing(mesh);
  double factor = coarsening(mesh, spacing);
  const LidMesh unrefined = mesh;
  for (;;) {
    for (double& s : spacing) s *= factor;
    if (refine_to(mesh, spacing)) return;
    mesh = unrefined;
    factor = 1.2;  // the estimate was too low
  }
}

}  // namespace lacuna::io
