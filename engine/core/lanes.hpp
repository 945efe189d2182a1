// Numbers of several points side by side in one register, and the functions of them that the hot stages
// need. Formulas are written once, for a `Real` that is a `double` or `Lanes`.
//
// Sources named *.lanes.cpp are compiled once per instruction set (CMakeLists.txt), each time in a
// namespace of its own, with registers of their full width; `core/dispatch.hpp` picks one when the program
// starts. No fused multiply-add and no reordering: the same bits from each. These sources include nothing
// that leaves functions behind which other code would share: no containers, no Eigen.
#pragma once

#include "engine/core/eight.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#if !defined(LACUNA_LANES)
#define LACUNA_LANES plain
#endif
#define LACUNA_INLINE inline __attribute__((always_inline))

namespace lacuna {
inline namespace LACUNA_LANES {

#if defined(__AVX512F__)
inline constexpr std::size_t kLaneBytes = 64;
#elif defined(__AVX2__)
inline constexpr std::size_t kLaneBytes = 32;
#else
inline constexpr std::size_t kLaneBytes = 16;
#endif
inline constexpr std::size_t kLanes = kLaneBytes / sizeof(double);

using Lanes = double __attribute__((vector_size(kLaneBytes)));
using LaneBits =
    std::int64_t __attribute__((vector_size(kLaneBytes)));  // as a mask: all bits of a lane or none

using SingleLanes = float __attribute__((vector_size(kLanes * sizeof(float))));

// Twice as many numbers, of single precision, and whole ones.
inline constexpr std::size_t kSingles = kLaneBytes / sizeof(float);
using Singles = float __attribute__((vector_size(kLaneBytes)));
using SingleBits = std::uint32_t __attribute__((vector_size(kLaneBytes)));

// As many of eight numbers of single precision as fit.
inline constexpr std::size_t kSinglesOfEight = kSingles < kEight ? kSingles : kEight;
using SinglesOfEight = float __attribute__((vector_size(kSinglesOfEight * sizeof(float))));
using SinglesOfEightBits = std::int32_t __attribute__((vector_size(sizeof(SinglesOfEight))));

template <class Register, class Number>
LACUNA_INLINE Register load_as(const Number* from) {
  Register numbers;
  __builtin_memcpy(&numbers, from, sizeof numbers);
  return numbers;
}
LACUNA_INLINE Lanes load(const double* from) {
  return load_as<Lanes>(from);
}
LACUNA_INLINE Singles load(const float* from) {
  return load_as<Singles>(from);
}
template <class Number, class Register>
LACUNA_INLINE void store(Number* to, Register numbers) {
  static_assert(sizeof *to == sizeof numbers[0]);
  __builtin_memcpy(to, &numbers, sizeof numbers);
}
LACUNA_INLINE Lanes all_lanes(double value) {
  return value - Lanes{};
}
LACUNA_INLINE Singles all_lanes(float value) {
  return value - Singles{};
}

LACUNA_INLINE bool any(LaneBits mask) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX2__)
  return !_mm256_testz_si256(reinterpret_cast<__m256i>(mask), reinterpret_cast<__m256i>(mask));
#else
  std::int64_t some = 0;
  for (std::size_t i = 0; i < kLanes; ++i) some |= mask[i];
  return some != 0;
#endif
}

// A bit for each lane of a mask.
LACUNA_INLINE std::uint32_t chosen_lanes(SingleBits mask) {
#if defined(__AVX512F__)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
  std::uint32_t chosen = 0;
  for (std::size_t i = 0; i < kSingles; ++i) chosen |= (mask[i] & 1) << i;
  return chosen;
#endif
}

// A bit for each lane whose number is at most the limit.
LACUNA_INLINE std::uint32_t lanes_up_to(Lanes numbers, double limit) {
#if defined(__AVX512F__)
  return _mm512_cmp_pd_mask(numbers, all_lanes(limit), _CMP_LE_OQ);
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_pd(numbers <= limit));
#else
  std::uint32_t chosen = 0;
  for (std::size_t i = 0; i < kLanes; ++i) chosen |= static_cast<std::uint32_t>(numbers[i] <= limit) << i;
  return chosen;
#endif
}
LACUNA_INLINE std::uint32_t lanes_up_to(Singles numbers, float limit) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask(numbers, all_lanes(limit), _CMP_LE_OQ);
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(numbers <= limit)));
#else
  std::uint32_t chosen = 0;
  for (std::size_t i = 0; i < kSingles; ++i) chosen |= static_cast<std::uint32_t>(numbers[i] <= limit) << i;
  return chosen;
#endif
}

#if defined(__AVX2__) && !defined(__AVX512F__)
// The numbers of the lanes that are chosen, one after the other; by the bits of the choice.
struct PackedLanes {
  alignas(kSingles) std::uint8_t lanes[1 << kSingles][kSingles];

  consteval PackedLanes() : lanes{} {
    for (std::size_t chosen = 0; chosen < std::size(lanes); ++chosen) {
      std::size_t count = 0;
      for (std::size_t lane = 0; lane < kSingles; ++lane) {
        if ((chosen >> lane & 1) != 0) lanes[chosen][count++] = static_cast<std::uint8_t>(lane);
      }
    }
  }
};
inline constexpr PackedLanes kPackedLanes;
#endif

// Which lanes of a register are chosen, to store their numbers one after the other. Each time a whole
// register is written.
class Choice {
 public:
  explicit LACUNA_INLINE Choice(std::uint32_t chosen) : chosen_(chosen) {
#if defined(__AVX2__) && !defined(__AVX512F__)
    lanes_ =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(kPackedLanes.lanes[chosen])));
#endif
  }

  LACUNA_INLINE std::size_t count() const {
    return static_cast<std::size_t>(__builtin_popcount(chosen_));
  }

  LACUNA_INLINE void pack(float* to, Singles from) const {
#if defined(__AVX512F__)
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(chosen_), from));
#elif defined(__AVX2__)
    _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(from, lanes_));
#else
    pack_one_by_one(to, from);
#endif
  }
  LACUNA_INLINE void pack(std::uint32_t* to, SingleBits from) const {
#if defined(__AVX512F__)
    _mm512_storeu_si512(
        to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(chosen_), reinterpret_cast<__m512i>(from)));
#elif defined(__AVX2__)
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                        _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(from), lanes_));
#else
    pack_one_by_one(to, from);
#endif
  }

 private:
#if !defined(__AVX2__)
  template <class Number, class Numbers>
  LACUNA_INLINE void pack_one_by_one(Number* to, const Numbers& from) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kSingles; ++i) {
      to[count] = from[i];
      count += chosen_ >> i & 1;
    }
  }
#endif

  std::uint32_t chosen_;
#if defined(__AVX2__) && !defined(__AVX512F__)
  __m256i lanes_;
#endif
};

LACUNA_INLINE double select(bool mask, double a, double b) {
  return mask ? a : b;
}
LACUNA_INLINE Lanes select(LaneBits mask, Lanes a, Lanes b) {
  return mask ? a : b;
}
LACUNA_INLINE float select(bool mask, float a, float b) {
  return mask ? a : b;
}
template <class Mask>
LACUNA_INLINE SingleLanes select(Mask mask, SingleLanes a, SingleLanes b) {
  return mask ? a : b;
}

LACUNA_INLINE float single(double x) {
  return static_cast<float>(x);
}
LACUNA_INLINE SingleLanes single(Lanes x) {
  return __builtin_convertvector(x, SingleLanes);
}

template <class Real>
LACUNA_INLINE Real smaller(Real a, Real b) {
  return a < b ? a : b;
}
template <class Real>
LACUNA_INLINE Real larger(Real a, Real b) {
  return a > b ? a : b;
}

LACUNA_INLINE double root(double x) {
  return __builtin_sqrt(x);
}
template <class Register>
LACUNA_INLINE Register root_of_each(Register x) {
  static_assert(sizeof x[0] == sizeof(double));
  Register roots;
  for (std::size_t i = 0; i < sizeof x / sizeof x[0]; ++i) roots[i] = __builtin_sqrt(x[i]);
  return roots;
}
LACUNA_INLINE Lanes root(Lanes x) {
  return root_of_each(x);
}
LACUNA_INLINE float root(float x) {
  return __builtin_sqrtf(x);
}
LACUNA_INLINE SingleLanes root(SingleLanes x) {
  SingleLanes roots;
  for (std::size_t i = 0; i < kLanes; ++i) roots[i] = __builtin_sqrtf(x[i]);
  return roots;
}

LACUNA_INLINE std::int64_t bits(double x) {
  return std::bit_cast<std::int64_t>(x);
}
LACUNA_INLINE LaneBits bits(Lanes x) {
  return reinterpret_cast<LaneBits>(x);
}
LACUNA_INLINE double from_bits(std::int64_t x) {
  return std::bit_cast<double>(x);
}
LACUNA_INLINE Lanes from_bits(LaneBits x) {
  return reinterpret_cast<Lanes>(x);
}

template <class Real>
LACUNA_INLINE Real magnitude(Real x) {
  return from_bits(bits(x) & INT64_MAX);
}

// exp(x) for -600 <= x <= 0, to 1e-14; 0 from -700 down.
template <class Real>
LACUNA_INLINE Real exponential(Real x) {
  constexpr double kLn2High = 6.93145751953125e-1, kLn2Low = 1.42860682030941723212e-6;
  constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest integer in the lowest bits
  const Real bounded = larger(x, Real{} - 700.0);
  const Real shifted = bounded * std::numbers::log2e + kRound;
  const Real n = shifted - kRound;
  const Real r = (bounded - n * kLn2High) - n * kLn2Low;  // |r| <= ln 2 / 2
  // Taylor to r^11: the next term is below 7e-15. Even and odd powers apart: neither waits for the other.
  const Real z = r * r;
  Real even = z * (1.0 / 3628800) + 1.0 / 40320;
  Real odd = z * (1.0 / 39916800) + 1.0 / 362880;
  even = even * z + 1.0 / 720;
  odd = odd * z + 1.0 / 5040;
  even = even * z + 1.0 / 24;
  odd = odd * z + 1.0 / 120;
  even = even * z + 0.5;
  odd = odd * z + 1.0 / 6;
  even = even * z + 1.0;
  odd = odd * z + 1.0;
  const Real power = from_bits((bits(shifted) + 1023) << 52);
  return select(x > -700.0, (even + odd * r) * power, Real{});
}

// The angle of the direction (x, y) in [-pi, pi], to 2 units in the last place; (0, 0) gives 0.
// After Moshier, Cephes (atan.c): one reduction to |t| <= tan(pi / 8) and a rational function.
template <class Real>
LACUNA_INLINE Real angle_of(Real y, Real x) {
  constexpr double kPi = std::numbers::pi;
  constexpr double kTanEighth = 0.41421356237309503;  // tan(pi / 8)
  const Real ax = magnitude(x), ay = magnitude(y);
  const Real large = larger(ax, ay), small = smaller(ax, ay);
  // tan(a - pi / 4) = (tan a - 1) / (tan a + 1)
  const auto steep = small > kTanEighth * large;
  const Real numerator = select(steep, small - large, small);
  const Real denominator = select(steep, small + large, large);
  const Real t = numerator / select(denominator > 0.0, denominator, Real{} + 1.0);
  const Real z = t * t;
  const Real p =
      ((((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z -
        1.228866684490136173410e2) *
           z -
       6.485021904942025371773e1);
  const Real q =
      (((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) *
            z +
        4.853903996359136964868e2) *
           z +
       1.945506571482613964425e2);
  Real angle = t + t * (z * p / q);
  angle = select(steep, angle + kPi / 4, angle);
  angle = select(ay > ax, kPi / 2 - angle, angle);
  angle = select(x < 0.0, kPi - angle, angle);
  return select(y < 0.0, -angle, angle);
}

// Sine and cosine of 0 <= x <= pi / 3, to 1e-16.
template <class Real>
LACUNA_INLINE void sine_and_cosine(Real x, Real& sine, Real& cosine) {
  const Real z = x * x;
  Real s = z * (1.0 / 355687428096000) - 1.0 / 1307674368000;
  s = s * z + 1.0 / 6227020800;
  s = s * z - 1.0 / 39916800;
  s = s * z + 1.0 / 362880;
  s = s * z - 1.0 / 5040;
  s = s * z + 1.0 / 120;
  s = s * z - 1.0 / 6;
  sine = x + x * (s * z);
  Real c = z * (-1.0 / 6402373705728000) + 1.0 / 20922789888000;
  c = c * z - 1.0 / 87178291200;
  c = c * z + 1.0 / 479001600;
  c = c * z - 1.0 / 3628800;
  c = c * z + 1.0 / 40320;
  c = c * z - 1.0 / 720;
  c = c * z + 1.0 / 24;
  c = c * z - 0.5;
  cosine = c * z + 1.0;
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
