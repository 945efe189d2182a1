// Shape criterion (paper, 4.4): the eigenvalues of the neighbourhood's covariance tell what shape it has.
#include "engine/criteria/criterion.hpp"

#include <array>
#include <cmath>

namespace lacuna {

double shape_probability(const LocalSurface& surface) {
  const Eigen::Vector3d boundary(2.0 / 3, 1.0 / 3, 0);
  const Eigen::Vector3d interior(1.0 / 2, 1.0 / 2, 0);
  const Eigen::Vector3d corner(1.0 / 3, 1.0 / 3, 1.0 / 3);  // or noise
  const Eigen::Vector3d line(1, 0, 0);
  const Eigen::Vector3d centroid(11.0 / 18, 5.0 / 18, 1.0 / 9);  // of the triangle of the last three

  const Eigen::Vector3d positive = surface.eigenvalues.cwiseMax(0.0);
  const double sum = positive.sum();
  const Eigen::Vector3d lambda = sum > 0 ? Eigen::Vector3d(positive / sum) : corner;

  double total = 0, share = 0;
  for (const Eigen::Vector3d* shape : {&boundary, &interior, &corner, &line}) {
    const double squared_width = (*shape - centroid).squaredNorm() / 9;  // s = |Lambda - c| / 3
    const double kernel = std::exp(-(lambda - *shape).squaredNorm() / squared_width);
    total += kernel;
    if (shape == &boundary) share = kernel;
  }
  return total > 0 ? share / total : 0;
}

}  // namespace lacuna
