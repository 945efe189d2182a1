// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/lid_mesh.hpp"

#include <Eigen/Geometry>

namespace lacuna::io {

Eigen::Vector3d area_vector(const LidMesh& mesh, const LidTriangle& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a) / 2;
}

double area(const LidMesh& mesh) {
  double sum = 0;
  for (const LidTriangle& triangle : mesh.triangles) sum += area_vector(mesh, triangle).norm();
  return sum;
}

}  // namespace lacuna::io
