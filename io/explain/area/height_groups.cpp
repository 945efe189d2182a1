// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/height_groups.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna::io {
namespace {

// Poses and units round one value differently.
bool has_one_value(const HeightGroup& group) {
  constexpr double kRounding = 1e-6;
  return group.high - group.low <= kRounding * std::max(std::abs(group.low), std::abs(group.high));
}

}  // namespace

void HeightGroups::add(double height) {
  constexpr std::size_t kMost = 16'384;
  if (last_ < groups_.size() && groups_[last_].low <= height && height <= groups_[last_].high) {
    ++groups_[last_].points;
    return;
  }
  auto at = std::ranges::lower_bound(groups_, height - gap_, {}, &HeightGroup::high);
  if (at == groups_.end() || at->low > height + gap_) {
    if (groups_.size() == kMost) {
      ++others_;
      return;
    }
    at = groups_.insert(at, {height, height, 0});
  }
  at->low = std::min(at->low, height);
  at->high = std::max(at->high, height);
  ++at->points;
  if (const auto next = at + 1; next != groups_.end() && next->low - at->high <= gap_) {
    at->high = next->high;
    at->points += next->points;
    groups_.erase(next);
  }
  last_ = static_cast<std::size_t>(at - groups_.begin());
}

HeightGroups::Parts HeightGroups::parts() const {
  constexpr std::uint64_t kTwentieth = 20;
  std::uint64_t all = others_;
  for (const HeightGroup& group : groups_) all += group.points;
  Parts parts;
  for (const HeightGroup& group : groups_) {
    const bool is_ground = !has_one_value(group) && group.points * kTwentieth >= all;
    (is_ground ? parts.ground : parts.apart).push_back(group);
  }
  if (parts.ground.empty() && !parts.apart.empty()) {
    const auto largest = std::ranges::max_element(parts.apart, {}, &HeightGroup::points);
    parts.ground.push_back(*largest);
    parts.apart.erase(largest);
  }
  return parts;
}

bool is_of(const std::vector<HeightGroup>& groups, double height, double gap) {
  return std::ranges::any_of(groups, [&](const HeightGroup& group) {
    return group.low - gap <= height && height <= group.high + gap;
  });
}

}  // namespace lacuna::io
