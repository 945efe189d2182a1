#include "engine/core/vector_math.hpp"

#include "engine/core/dispatch.hpp"

#include <bit>
#include <cmath>
#include <numbers>

namespace lacuna {

LACUNA_VECTORISED
void atan2_each(const double* y, const double* x, std::size_t count, double* angles) {
  constexpr double kPi = std::numbers::pi;
  constexpr double kTanEighth = 0.41421356237309503;  // tan(pi / 8)
  for (std::size_t i = 0; i < lanes(count); ++i) {
    const double ax = std::abs(x[i]), ay = std::abs(y[i]);
    const double large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
    // tan(a - pi / 4) = (tan a - 1) / (tan a + 1)
    const bool steep = small > kTanEighth * large;
    const double numerator = steep ? small - large : small;
    const double denominator = steep ? small + large : large;
    const double t = numerator / (denominator > 0 ? denominator : 1.0);
    const double z = t * t;
    const double p =
        ((((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) *
              z -
          1.228866684490136173410e2) *
             z -
         6.485021904942025371773e1);
    const double q = (((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z +
                        4.328810604912902668951e2) *
                           z +
                       4.853903996359136964868e2) *
                          z +
                      1.945506571482613964425e2);
    double angle = t + t * (z * p / q);
    angle = steep ? angle + kPi / 4 : angle;
    angle = ay > ax ? kPi / 2 - angle : angle;
    angle = x[i] < 0 ? kPi - angle : angle;
    angles[i] = y[i] < 0 ? -angle : angle;
  }
}

LACUNA_VECTORISED
void exp_each(const double* x, std::size_t count, double* values) {
  constexpr double kLn2High = 6.93145751953125e-1, kLn2Low = 1.42860682030941723212e-6;
  constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest integer in the lowest bits
  for (std::size_t i = 0; i < lanes(count); ++i) {
    const double bounded = x[i] > -700.0 ? x[i] : -700.0;
    const double shifted = bounded * std::numbers::log2e + kRound;
    const double n = shifted - kRound;
    const double r = (bounded - n * kLn2High) - n * kLn2Low;  // |r| <= ln 2 / 2
    // Taylor to r^13: the next term is below 1e-17.
    double sum = 1.0 / 6227020800;
    sum = sum * r + 1.0 / 479001600;
    sum = sum * r + 1.0 / 39916800;
    sum = sum * r + 1.0 / 3628800;
    sum = sum * r + 1.0 / 362880;
    sum = sum * r + 1.0 / 40320;
    sum = sum * r + 1.0 / 5040;
    sum = sum * r + 1.0 / 720;
    sum = sum * r + 1.0 / 120;
    sum = sum * r + 1.0 / 24;
    sum = sum * r + 1.0 / 6;
    sum = sum * r + 0.5;
    sum = sum * r + 1.0;
    sum = sum * r + 1.0;
    const std::uint64_t power = (std::bit_cast<std::uint64_t>(shifted) + 1023) << 52;
    values[i] = x[i] > -700.0 ? sum * std::bit_cast<double>(power) : 0.0;
  }
}

LACUNA_VECTORISED
void count_smaller(const double* values, std::size_t count, std::uint32_t* ranks) {
  for (std::size_t first = 0; first < count; first += kLanes) {
    std::uint64_t smaller[kLanes] = {};
    for (std::size_t j = 0; j < count; ++j) {
      const double other = values[j];
      for (std::size_t i = 0; i < kLanes; ++i) smaller[i] += other < values[first + i];
    }
    for (std::size_t i = 0; i < kLanes; ++i) ranks[first + i] = static_cast<std::uint32_t>(smaller[i]);
  }
}

}  // namespace lacuna
