// Shape criterion (paper, 4.4): the eigenvalues of the neighbourhood's covariance tell what shape it has.
#include "engine/core/vector_math.hpp"
#include "engine/criteria/criterion.hpp"

#include <array>
#include <cmath>

namespace lacuna {

double shape_probability(const LocalSurface& surface) {
  // Boundary, interior, corner or noise, line; the centroid is that of the triangle of the last three.
  constexpr std::size_t kShapes = 4;
  static const std::array<Eigen::Vector3d, kShapes> shapes{
      Eigen::Vector3d(2.0 / 3, 1.0 / 3, 0), Eigen::Vector3d(1.0 / 2, 1.0 / 2, 0),
      Eigen::Vector3d(1.0 / 3, 1.0 / 3, 1.0 / 3), Eigen::Vector3d(1, 0, 0)};
  static const Eigen::Vector3d centroid(11.0 / 18, 5.0 / 18, 1.0 / 9);

  const Eigen::Vector3d positive = surface.eigenvalues.cwiseMax(0.0);
  const double sum = positive.sum();
  const Eigen::Vector3d lambda = sum > 0 ? Eigen::Vector3d(positive / sum) : shapes[2];

  std::array<double, lanes(kShapes)> kernels{};
  for (std::size_t i = 0; i < kShapes; ++i) {
    const double squared_width = (shapes[i] - centroid).squaredNorm() / 9;  // s = |Lambda - c| / 3
    kernels[i] = -(lambda - shapes[i]).squaredNorm() / squared_width;
  }
  exp_each(kernels.data(), kShapes, kernels.data());
  const double total = ((kernels[0] + kernels[1]) + kernels[2]) + kernels[3];
  return total > 0 ? kernels[0] / total : 0;
}

}  // namespace lacuna
