// SPDX-License-Identifier: Apache-2.0
#include "io/lids/fair.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

namespace lacuna::io {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;
constexpr double kMostCotangent = 1e4;  // of needles, which would spoil the digits of all others

// The Laplacian of all vertices, split by columns into the loop's and the inner ones.
struct Laplacian {
  Matrix of_loop, of_inner;
  Eigen::VectorXd masses;  // a third of the areas around each vertex
};

Laplacian laplacian(const LidMesh& mesh) {
  const auto vertices = static_cast<Eigen::Index>(mesh.vertices.size());
  const auto loop = static_cast<Eigen::Index>(mesh.loop_points);
  std::vector<Eigen::Triplet<double>> of_loop, of_inner;
  const auto add = [&](std::uint32_t row, std::uint32_t column, double value) {
    if (column < loop) {
      of_loop.emplace_back(row, column, value);
    } else {
      of_inner.emplace_back(row, static_cast<Eigen::Index>(column) - loop, value);
    }
  };
  Laplacian made;
  made.masses = Eigen::VectorXd::Zero(vertices);
  for (const LidTriangle& triangle : mesh.triangles) {
    const double area = area_vector(mesh, triangle).norm();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t at = triangle[corner], a = triangle[(corner + 1) % 3],
                          b = triangle[(corner + 2) % 3];
      made.masses[at] += area / 3;
      const double dot = (mesh.vertices[a] - mesh.vertices[at]).dot(mesh.vertices[b] - mesh.vertices[at]);
      if (std::abs(dot) == 0) continue;  // also without an area
      const double half = std::clamp(dot / (2 * area), -kMostCotangent, kMostCotangent) / 2;
      for (const auto& [row, column] : {std::pair{a, b}, std::pair{b, a}}) {
        add(row, column, half);
        add(row, row, -half);
      }
    }
  }
  constexpr double kLeastMass = 1e-3;  // of the mean
  made.masses = made.masses.cwiseMax(kLeastMass * made.masses.mean());
  made.of_loop.resize(vertices, loop);
  made.of_inner.resize(vertices, vertices - loop);
  made.of_loop.setFromTriplets(of_loop.begin(), of_loop.end());
  made.of_inner.setFromTriplets(of_inner.begin(), of_inner.end());
  return made;
}

Rows rows_of(std::span<const Eigen::Vector3d> points) {
  Rows rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  return rows;
}

Rows loop_rows(const LidMesh& mesh) {
  return rows_of(std::span(mesh.vertices).first(mesh.loop_points));
}

// Returns nothing if the matrix is not positive definite, or a number is not finite.
std::optional<Rows> solve(const Matrix& matrix, const Rows& right) {
  const Eigen::SimplicialLDLT<Matrix> factor(matrix);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0)) return std::nullopt;
  Rows solution = factor.solve(right);
  if (!solution.allFinite()) return std::nullopt;
  return solution;
}

std::optional<Rows> membrane(const LidMesh& mesh, const Laplacian& laplacian) {
  const Eigen::Index inner = laplacian.of_inner.cols();
  return solve(-laplacian.of_inner.bottomRows(inner), laplacian.of_loop.bottomRows(inner) * loop_rows(mesh));
}

void place_inner(LidMesh& mesh, const Rows& rows) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    mesh.vertices[mesh.loop_points + static_cast<std::size_t>(i)] = rows.row(i).transpose();
}

Eigen::Vector3d unit_or_zero(const Eigen::Vector3d& vector) {
  const double length = vector.norm();
  return length > 0 && std::isfinite(length) ? Eigen::Vector3d(vector / length) : Eigen::Vector3d(0, 0, 0);
}

// Returns at each point of the loop the side of the surface from which the loop runs anticlockwise.
std::vector<Eigen::Vector3d> surface_normals(const LidMesh& mesh, std::span<const std::uint32_t> next,
                                             std::span<const Eigen::Vector3d> surface) {
  const std::size_t n = mesh.loop_points;
  std::vector<std::uint32_t> before(n);
  for (std::uint32_t i = 0; i < n; ++i) before[next[i]] = i;
  constexpr std::size_t kReach = 4;  // points on each side of one
  std::vector<Eigen::Vector3d> turns(n), normals(n);
  for (std::size_t i = 0; i < n; ++i)
    turns[i] = surface[i].cross(mesh.vertices[next[i]] - mesh.vertices[before[i]]);
  for (std::uint32_t i = 0; i < n; ++i) {
    std::size_t size = 1;  // of the loop, or enough for the reach
    for (std::uint32_t at = next[i]; at != i && size < 2 * kReach + 1; at = next[at]) ++size;
    const std::size_t reach = (size - 1) / 2;
    Eigen::Vector3d sum = static_cast<double>(reach + 1) * turns[i];
    std::uint32_t left = i, right = i;
    for (std::size_t step = 1; step <= reach; ++step) {
      left = before[left];
      right = next[right];
      sum += static_cast<double>(reach + 1 - step) * (turns[right] + turns[left]);
    }
    normals[i] = unit_or_zero(sum);
  }
  return normals;
}

// Returns the unit vector out of the lid, perpendicular to each edge of the loop.
std::vector<Eigen::Vector3d> ends_of_lid(const LidMesh& mesh, std::span<const std::uint32_t> next) {
  const std::size_t n = mesh.loop_points;
  std::vector<Eigen::Vector3d> out(n, Eigen::Vector3d(0, 0, 0));
  for (const LidTriangle& triangle : mesh.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t a = triangle[corner], b = triangle[(corner + 1) % 3];
      if (a >= n || b != next[a]) continue;
      const Eigen::Vector3d along = mesh.vertices[b] - mesh.vertices[a];
      out[a] = unit_or_zero(along.cross(area_vector(mesh, triangle)));
    }
  }
  return out;
}

// Returns the flux of each vertex of the loop.
Rows flux(const LidMesh& mesh, std::span<const Eigen::Vector3d> surface) {
  const std::size_t n = mesh.loop_points;
  const std::vector<std::uint32_t> next = next_on_loops(mesh);
  const std::vector<Eigen::Vector3d> normals = surface_normals(mesh, next, surface),
                                     ends = ends_of_lid(mesh, next);
  Rows sum = Rows::Zero(static_cast<Eigen::Index>(n), 3);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d along = mesh.vertices[next[i]] - mesh.vertices[i];
    const Eigen::Vector3d to_surface = unit_or_zero(along.cross(normals[i] + normals[next[i]]));
    constexpr double kFull = 0.5, kNone = 0.0872;  // cosines of 60 and 85 degrees
    const double share = std::clamp((to_surface.dot(ends[i]) - kNone) / (kFull - kNone), 0.0, 1.0);
    const Eigen::Vector3d out = unit_or_zero(share * to_surface + (1 - share) * ends[i]);
    for (const std::size_t end : {i, std::size_t{next[i]}})
      sum.row(static_cast<Eigen::Index>(end)) += (along.norm() / 2 * out).transpose();
  }
  return sum;
}

std::optional<Rows> thin_plate(const LidMesh& mesh, std::span<const Eigen::Vector3d> surface) {
  const Laplacian of = laplacian(mesh);
  Rows fixed = of.of_loop * loop_rows(mesh);
  fixed.topRows(static_cast<Eigen::Index>(mesh.loop_points)) += flux(mesh, surface);
  const Matrix weighted = of.masses.cwiseInverse().asDiagonal() * of.of_inner;
  const Matrix normal = of.of_inner.transpose() * weighted;
  return solve(normal, -(weighted.transpose() * fixed));
}

bool is_near_loop(const LidMesh& mesh, const Rows& rows) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < mesh.loop_points; ++i) box.extend(mesh.vertices[i]);
  const double diagonal = box.diagonal().norm();
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (box.exteriorDistance(rows.row(i).transpose().eval()) > diagonal) return false;
  }
  return true;
}

}  // namespace

void fair_membrane(LidMesh& mesh) {
  if (mesh.vertices.size() == mesh.loop_points) return;
  if (const std::optional<Rows> rows = membrane(mesh, laplacian(mesh))) place_inner(mesh, *rows);
}

Fairing fair(LidMesh& mesh, std::span<const Eigen::Vector3d> surface) {
  assert(surface.size() == mesh.loop_points);
  fair_membrane(mesh);
  if (mesh.vertices.size() == mesh.loop_points) return Fairing::kMembrane;
  const std::optional<Rows> rows = thin_plate(mesh, surface);
  if (!rows || !is_near_loop(mesh, *rows)) return Fairing::kMembrane;
  place_inner(mesh, *rows);
  return Fairing::kThinPlate;
}

}  // namespace lacuna::io
