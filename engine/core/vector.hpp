// Vectors of three numbers, for a `Real` that is one number or those of several points (core/lanes).
#pragma once

#include "engine/core/lanes.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

template <class Real>
struct Vector {
  Real x, y, z;

  friend LACUNA_INLINE Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend LACUNA_INLINE Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend LACUNA_INLINE Vector operator*(Vector a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
  friend LACUNA_INLINE Vector operator/(Vector a, Real s) { return {a.x / s, a.y / s, a.z / s}; }
};

template <class Real>
LACUNA_INLINE Real dot(Vector<Real> a, Vector<Real> b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class Real>
LACUNA_INLINE Vector<Real> cross(Vector<Real> a, Vector<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
LACUNA_INLINE Real norm(Vector<Real> a) {
  return root(dot(a, a));
}
template <class Mask, class Real>
LACUNA_INLINE Vector<Real> select(Mask mask, Vector<Real> a, Vector<Real> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
