// SPDX-License-Identifier: Apache-2.0
// Finds which of many spheres hold a place.
#pragma once

#include "bench/synth/random.hpp"
#include "bench/synth/vec3.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace lacuna::synth {

struct Sphere {
  Vec3 centre;
  double radius;  // above 0
};

// Spheres of similar radius share a lattice of cells no smaller than the spheres. A place that no sphere is
// near costs one bit per lattice.
class SphereIndex {
 public:
  explicit SphereIndex(std::vector<Sphere> spheres);

  // Calls `use(number)` for each sphere that holds the place, in no useful order.
  template <typename Use>
  void for_each_around(Vec3 place, const Use& use) const {
    for (const Level& level : levels_) {
      const std::uint64_t key =
          key_of(level, cell(place.x, level), cell(place.y, level), cell(place.z, level));
      if (!present_[key & mask_]) continue;
      auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::pair(key, std::uint32_t{0}));
      for (; entry != entries_.end() && entry->first == key; ++entry) {
        const Sphere& sphere = spheres_[entry->second];
        const Vec3 arm = place - sphere.centre;
        if (dot(arm, arm) <= sphere.radius * sphere.radius) use(entry->second);
      }
    }
  }

  const std::vector<Sphere>& spheres() const { return spheres_; }

 private:
  // Cells are a power of two wide.
  struct Level {
    int exponent;
    double cells_per_metre;

    friend auto operator<=>(const Level&, const Level&) = default;
  };
  static std::int64_t cell(double coordinate, const Level& level) {
    return static_cast<std::int64_t>(std::floor(coordinate * level.cells_per_metre));
  }
  static std::uint64_t key_of(const Level& level, std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t key = mix(static_cast<std::uint64_t>(level.exponent) + 1);
    for (const std::int64_t axis : {x, y, z}) key = mix(key + static_cast<std::uint64_t>(axis) * 3);
    return key;
  }

  std::vector<Sphere> spheres_;
  std::vector<Level> levels_;                                     // ascending
  std::vector<std::pair<std::uint64_t, std::uint32_t>> entries_;  // cell and sphere, ascending
  std::vector<bool> present_;                                     // keys modulo its size
  std::uint64_t mask_ = 0;
};

}  // namespace lacuna::synth
