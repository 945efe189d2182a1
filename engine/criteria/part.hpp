// Some points of a bundle in registers. For *.lanes.cpp (core/lanes).
#pragma once

#include "engine/core/vector.hpp"
#include "engine/criteria/bundle.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

inline constexpr std::size_t kParts = kBundle / kLanes;

// As many as a register holds, from `first` on.
struct Part {
  const Bundle& bundle;
  std::size_t first;

  LACUNA_INLINE Lanes get(const Eight& numbers) const { return load(numbers.at + first); }
  LACUNA_INLINE void set(Eight& numbers, Lanes values) const { store(numbers.at + first, values); }

  LACUNA_INLINE Vector<Lanes> get(const Eight (&numbers)[3]) const {
    return {get(numbers[0]), get(numbers[1]), get(numbers[2])};
  }
  LACUNA_INLINE void set(Eight (&numbers)[3], Vector<Lanes> values) const {
    set(numbers[0], values.x);
    set(numbers[1], values.y);
    set(numbers[2], values.z);
  }

  LACUNA_INLINE Vector<Lanes> offset(std::size_t row) const {
    return {get(bundle.x[row]), get(bundle.y[row]), get(bundle.z[row])};
  }
  // Of another row for each point; `rows`: by lane.
  template <class Rows>
  Vector<Lanes> offset_in_rows(const Rows& rows) const {
    Vector<Lanes> offsets{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto row = static_cast<std::size_t>(rows[lane] > 0 ? rows[lane] : 0);
      offsets.x[lane] = bundle.x[row].at[first + lane];
      offsets.y[lane] = bundle.y[row].at[first + lane];
      offsets.z[lane] = bundle.z[row].at[first + lane];
    }
    return offsets;
  }
};

}  // namespace LACUNA_LANES
}  // namespace lacuna
