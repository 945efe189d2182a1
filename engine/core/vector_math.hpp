// Elementary functions over whole rows, in vector arithmetic: the same bits from every instruction set.
//
// Arrays hold whole lanes: `lanes(count)` elements, of which those from `count` on may be anything and are
// overwritten with anything. A remainder done one by one would take longer than all the rest.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kLanes = 8;
constexpr std::size_t lanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

// Angles of the directions (x, y) in [-pi, pi], to 2 units in the last place; (0, 0) gives 0.
// After Moshier, Cephes (atan.c): one reduction to |t| <= tan(pi / 8) and a rational function.
void atan2_each(const double* y, const double* x, std::size_t count, double* angles);

// exp(x) for -600 <= x <= 0, to 2 units in the last place. Below, 0 or nearly so.
void exp_each(const double* x, std::size_t count, double* values);

// ranks[i]: how many of the values are smaller than values[i]; equal ones share a rank.
void count_smaller(const double* values, std::size_t count, std::uint32_t* ranks);

}  // namespace lacuna
