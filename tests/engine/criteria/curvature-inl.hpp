// SPDX-License-Identifier: Apache-2.0
// A criterion of the test's own, a part of formulas-inl.hpp there: how much the surface bends around a point.
// That is the share of the smallest eigenvalue (Pauly, Gross, Kobbelt, Efficient simplification of
// point-sampled surfaces, 2002), which is 1/3 at most.
template <class V>
HWY_INLINE V curvature_probability(const Surface<V>& surface) {
  const Vector<V>& values = surface.eigenvalues;
  const V sum = (values.x + values.y) + values.z, zero = all<V>(0);
  const V share = all<V>(3) * hn::Max(values.z, zero) / sum;
  return hn::IfThenElseZero(sum > zero, hn::Min(share, all<V>(1)));
}
