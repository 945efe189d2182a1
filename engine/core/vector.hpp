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

// Two directions at right angles to a normal and to each other, counterclockwise about it.
template <class Real>
struct Frame {
  Vector<Real> u, v;
};

// Duff et al., Building an Orthonormal Basis, Revisited (2017).
template <class Real>
LACUNA_INLINE Frame<Real> frame_of(Vector<Real> normal) {
  const Real sign = select(normal.z < 0.0, Real{} - 1.0, Real{} + 1.0);
  const Real s = -1.0 / (sign + normal.z), t = normal.x * normal.y * s;
  return {{1.0 + sign * normal.x * normal.x * s, sign * t, -sign * normal.x},
          {t, sign + normal.y * normal.y * s, -normal.y}};
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
