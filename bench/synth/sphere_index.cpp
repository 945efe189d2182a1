// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/sphere_index.hpp"

namespace lacuna::synth {

SphereIndex::SphereIndex(std::vector<Sphere> spheres) : spheres_(std::move(spheres)) {
  for (std::uint32_t number = 0; number < spheres_.size(); ++number) {
    const auto& [centre, radius] = spheres_[number];
    Level level{};
    std::frexp(2 * radius, &level.exponent);
    level.cells_per_metre = std::ldexp(1.0, -level.exponent);
    levels_.push_back(level);
    const auto low = [&](double at) { return cell(at - radius, level); };
    const auto high = [&](double at) { return cell(at + radius, level); };
    for (std::int64_t x = low(centre.x); x <= high(centre.x); ++x)
      for (std::int64_t y = low(centre.y); y <= high(centre.y); ++y)
        for (std::int64_t z = low(centre.z); z <= high(centre.z); ++z)
          entries_.emplace_back(key_of(level, x, y, z), number);
  }
  std::sort(levels_.begin(), levels_.end());
  levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());
  std::sort(entries_.begin(), entries_.end());
  std::uint64_t size = 1024;
  while (size < 16 * entries_.size()) size *= 2;
  mask_ = size - 1;
  present_.resize(size);
  for (const auto& entry : entries_) present_[entry.first & mask_] = true;
}

}  // namespace lacuna::synth
