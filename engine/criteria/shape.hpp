// Shape criterion (paper, 4.4): the eigenvalues of the neighbourhood's covariance tell what shape it has.
#pragma once

#include "engine/criteria/surface.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

struct CharacteristicShape {
  double eigenvalues[3];  // sum 1
  double squared_width;   // s^2 of its Gauss kernel
};

// s = |Lambda - c| / 3, with c the centroid of the triangle of interior, corner and line.
constexpr CharacteristicShape characteristic_shape(double first, double second, double third) {
  const double x = first - 11.0 / 18, y = second - 5.0 / 18, z = third - 1.0 / 9;
  return {{first, second, third}, ((x * x + y * y) + z * z) / 9};
}

inline constexpr CharacteristicShape kBoundaryShape = characteristic_shape(2.0 / 3, 1.0 / 3, 0);
inline constexpr CharacteristicShape kInteriorShape = characteristic_shape(1.0 / 2, 1.0 / 2, 0);
inline constexpr CharacteristicShape kCornerShape = characteristic_shape(1.0 / 3, 1.0 / 3, 1.0 / 3);
inline constexpr CharacteristicShape kLineShape = characteristic_shape(1, 0, 0);

template <class Real>
LACUNA_INLINE Real likeness(Vector<Real> lambda, const CharacteristicShape& shape) {
  const Real x = lambda.x - shape.eigenvalues[0], y = lambda.y - shape.eigenvalues[1],
             z = lambda.z - shape.eigenvalues[2];
  return exponential(-((x * x + y * y) + z * z) / shape.squared_width);
}

template <class Real>
LACUNA_INLINE Real shape_probability(const Surface<Real>& surface) {
  const Vector<Real>& values = surface.eigenvalues;
  const Vector<Real> positive{larger(values.x, Real{}), larger(values.y, Real{}), larger(values.z, Real{})};
  const Real sum = (positive.x + positive.y) + positive.z;
  const double* const corner = kCornerShape.eigenvalues;
  const Vector<Real> lambda = select(
      sum > 0.0, positive / sum, Vector<Real>{corner[0] + Real{}, corner[1] + Real{}, corner[2] + Real{}});
  const Real boundary = likeness(lambda, kBoundaryShape);
  const Real total = ((boundary + likeness(lambda, kInteriorShape)) + likeness(lambda, kCornerShape)) +
                     likeness(lambda, kLineShape);
  return select(total > 0.0, boundary / total, Real{});
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
