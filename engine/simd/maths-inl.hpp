// SPDX-License-Identifier: Apache-2.0
// exp, atan2, sine and cosine from + - * / and bits alone: the same bytes from every instruction set, and on
// every machine. The functions of the C library choose their instructions by machine. The functions of
// Highway (hwy/contrib/math) use MulAdd, which is fused on some targets only.
#if defined(LACUNA_SIMD_MATHS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_MATHS_INL
#undef LACUNA_SIMD_MATHS_INL
#else
#define LACUNA_SIMD_MATHS_INL
#endif

#include "engine/simd/vector-inl.hpp"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

// The first coefficient belongs to the highest power. Horner's rule.
template <class V, class... Coefficients>
HWY_INLINE V polynomial(V z, double first, Coefficients... others) {
  V sum = all<V>(first);
  ((sum = sum * z + all<V>(others)), ...);
  return sum;
}

// Returns exp(x) for -600 <= x <= 0, to 1e-14; 0 from -700 down.
template <class V>
HWY_INLINE V exponential(V x) {
  const hn::RebindToSigned<TagOf<V>> bits;
  const V ln2_high = all<V>(6.93145751953125e-1), ln2_low = all<V>(1.42860682030941723212e-6);
  const V round = all<V>(0x1.8p52);  // adding it leaves the nearest integer in the lowest bits
  const V bounded = hn::Max(x, all<V>(-700));
  const V shifted = bounded * all<V>(std::numbers::log2e) + round;
  const V n = shifted - round;
  const V r = (bounded - n * ln2_high) - n * ln2_low;  // |r| <= ln 2 / 2
  // Taylor to r^11: the next term is below 7e-15. Even and odd powers apart: neither depends on the other.
  const V z = r * r;
  const V even = polynomial(z, 1.0 / 3628800, 1.0 / 40320, 1.0 / 720, 1.0 / 24, 0.5, 1.0);
  const V odd = polynomial(z, 1.0 / 39916800, 1.0 / 362880, 1.0 / 5040, 1.0 / 120, 1.0 / 6, 1.0);
  const auto exponent = hn::BitCast(bits, shifted) + hn::Set(bits, 1023);
  const V power = hn::BitCast(TagOf<V>(), hn::ShiftLeft<52>(exponent));
  return hn::IfThenElseZero(x > all<V>(-700), (even + odd * r) * power);
}

// Returns the angle of the direction (x, y) in [-pi, pi], to 2 units in the last place; (0, 0) gives 0. After
// Moshier, Cephes (atan.c): one reduction to |t| <= tan(pi / 8) and a rational function.
template <class V>
HWY_INLINE V angle_of(V y, V x) {
  constexpr double kPi = std::numbers::pi;
  const V zero = all<V>(0), tan_eighth = all<V>(0.41421356237309503);  // tan(pi / 8)
  const V ax = hn::Abs(x), ay = hn::Abs(y);
  const V large = hn::Max(ax, ay), small = hn::Min(ax, ay);
  // tan(a - pi / 4) = (tan a - 1) / (tan a + 1)
  const auto steep = small > tan_eighth * large;
  const V numerator = hn::IfThenElse(steep, small - large, small);
  const V denominator = hn::IfThenElse(steep, small + large, large);
  const V t = numerator / hn::IfThenElse(denominator > zero, denominator, all<V>(1));
  const V z = t * t;
  const V p = polynomial(z, -8.750608600031904122785e-1, -1.615753718733365076637e1,
                         -7.500855792314704667340e1, -1.228866684490136173410e2, -6.485021904942025371773e1);
  const V q = polynomial(z, 1.0, 2.485846490142306297962e1, 1.650270098316988542046e2,
                         4.328810604912902668951e2, 4.853903996359136964868e2, 1.945506571482613964425e2);
  V angle = t + t * (z * p / q);
  angle = hn::IfThenElse(steep, angle + all<V>(kPi / 4), angle);
  angle = hn::IfThenElse(ay > ax, all<V>(kPi / 2) - angle, angle);
  angle = hn::IfThenElse(x < zero, all<V>(kPi) - angle, angle);
  return hn::IfThenElse(y < zero, hn::Neg(angle), angle);
}

// Returns sine and cosine of 0 <= x <= pi / 3, to 1e-16.
template <class V>
struct SineAndCosine {
  V sine, cosine;
};
template <class V>
HWY_INLINE SineAndCosine<V> sine_and_cosine(V x) {
  const V z = x * x;
  const V s = polynomial(z, 1.0 / 355687428096000, -1.0 / 1307674368000, 1.0 / 6227020800, -1.0 / 39916800,
                         1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6);
  const V c = polynomial(z, -1.0 / 6402373705728000, 1.0 / 20922789888000, -1.0 / 87178291200,
                         1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24, -0.5, 1.0);
  return {x + x * (s * z), c};
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
