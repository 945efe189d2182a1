// SPDX-License-Identifier: Apache-2.0
// Formulas of the stars. Batches of points use them, and so does the exact fallback for one point.
#if defined(LACUNA_BOUNDARY_STAR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_BOUNDARY_STAR_INL
#undef LACUNA_BOUNDARY_STAR_INL
#else
#define LACUNA_BOUNDARY_STAR_INL
#endif

#include "engine/boundary/tangential/stars.hpp"
#include "engine/simd/vector-inl.hpp"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace lacuna::tangential::HWY_NAMESPACE {
using namespace lacuna::HWY_NAMESPACE;

// A neighbour in the tangent plane, inverted; or the vector from one neighbour to another. NaN: undefined.
template <class V>
struct View {
  V x, y;
};

// Owing to the weights, the sphere through a triangle is orthogonal to small spheres around the points. So
// any two views of four points on one circle agree on its triangles.
template <class V>
HWY_INLINE View<V> view_of(Vector<V> offset, V weight, const Frame<V>& frame) {
  const V power = dot(offset, offset) + weight;
  const V undefined = all<V>(std::numeric_limits<double>::quiet_NaN());
  const V inverse = hn::IfThenElse(power > all<V>(0), all<V>(1) / power, undefined);
  return {dot(offset, frame.u) * inverse, dot(offset, frame.v) * inverse};
}

// Returns the circumradius of p and two neighbours, in units of `distance`. (x, y) is the view of one
// neighbour; (dx, dy) leads from there to the view of the other.
template <class V>
HWY_INLINE auto radius_at(V x, V y, V dx, V dy, V distance) {
  // Both values are without a unit. The rest is computed in single precision, as the result is kept so: roots
  // and quotients take a quarter of the time.
  const hn::Rebind<float, TagOf<V>> single;
  const V unit = distance * distance;
  const auto squared_length = hn::DemoteTo(single, (dx * dx + dy * dy) * unit);
  const auto height = hn::DemoteTo(single, (x * dy - y * dx) * (all<V>(2) * unit));  // times the length
  const auto largest = hn::Set(single, static_cast<float>(kLargestRadius));
  const auto radius = hn::Sqrt(squared_length) / height;
  return hn::IfThenElse(height > hn::Zero(single), hn::Min(radius, largest), largest);
}

}  // namespace lacuna::tangential::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
