// SPDX-License-Identifier: Apache-2.0
#include "engine/model/mixed.hpp"
#include "io/explain/area/empty_places.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <utility>

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

namespace {

constexpr unsigned kStepBits = 8;                   // of a place along an axis, within its cell
constexpr int kSteps = 1 << kStepBits, kNear = 32;  // of a cell, and of the distance of copies
constexpr int kSame = 1;                            // apart by rounding alone
constexpr unsigned kPlaceBits = 3 * kStepBits;

std::uint64_t hash_of(const Eigen::Array3d& cell, double time) {
  std::uint64_t hash = std::bit_cast<std::uint64_t>(time);
  for (const double value : cell) hash = mixed(hash ^ std::bit_cast<std::uint64_t>(value + 0.0));
  return std::max<std::uint64_t>(hash >> kPlaceBits, 1);
}

}  // namespace

RepeatedPoints::RepeatedPoints(CopyDistance apart, std::uint64_t memory)
    : apart_(apart), most_(std::bit_floor(std::max<std::uint64_t>(memory / 16, 1024))), slots_(1024) {}

bool RepeatedPoints::add(const Eigen::Vector3d& place, double time) {
  const double step = (time != 0 ? apart_.with_time : apart_.without_time) / kNear;
  const Eigen::Array3d steps = (place.array() / step).floor(), cell = (steps / kSteps).floor();
  const auto key_at = [&](const Eigen::Array3d& near) {
    Key key{hash_of(near, time), {}};
    const Eigen::Array3d rest = steps - near * kSteps;  // beyond 2^53 steps it is what rounding leaves
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      key.steps[static_cast<std::size_t>(axis)] =
          static_cast<int>(std::clamp(rest[axis], -2.0 * kSteps, 2.0 * kSteps));
    return key;
  };
  const Key own = key_at(cell);
  if (!is_in_sample(own.hash)) return false;
  // A copy may lie in the next cell along each axis.
  Eigen::Array3d side = Eigen::Array3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const int at = own.steps[static_cast<std::size_t>(axis)];
    side[axis] = at < kNear ? -1 : at >= kSteps - kNear ? 1 : 0;
  }
  int distance = nearest(own);
  for (unsigned sides = 1; sides < 8; ++sides) {
    Eigen::Array3d near = cell;
    bool is_cell = true;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if ((sides >> axis & 1) == 0) continue;
      is_cell = is_cell && side[axis] != 0;
      near[axis] += side[axis];
    }
    if (is_cell) distance = std::min(distance, nearest(key_at(near)));
  }
  if (distance <= (time != 0 ? kNear : kSame)) {
    ++count_;
    return true;
  }
  if (distance <= kNear) ++near_;
  std::uint64_t slot = own.hash;
  for (const int at : own.steps)
    slot = slot << kStepBits | static_cast<std::uint64_t>(std::clamp(at, 0, kSteps - 1));
  put(slot);
  if (4 * used_ > 3 * slots_.size()) make_space();
  return false;
}

bool RepeatedPoints::is_in_sample(std::uint64_t hash) const {
  return (hash & ((std::uint64_t{1} << sample_) - 1)) == 0;
}

std::size_t RepeatedPoints::slot_of(std::uint64_t hash) const {
  return mixed(hash) & (slots_.size() - 1);
}

// Returns the least distance of a point of the cell, in steps along the axis where it is largest; more than
// kNear without a point.
int RepeatedPoints::nearest(const Key& key) const {
  int least = kSteps;
  for (std::size_t at = slot_of(key.hash); slots_[at] != 0; at = (at + 1) & (slots_.size() - 1)) {
    if (slots_[at] >> kPlaceBits != key.hash) continue;
    int distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto other = static_cast<int>(slots_[at] >> (2 - axis) * kStepBits & (kSteps - 1));
      distance = std::max(distance, std::abs(other - key.steps[axis]));
    }
    least = std::min(least, distance);
  }
  return least;
}

void RepeatedPoints::put(std::uint64_t slot) {
  std::size_t at = slot_of(slot >> kPlaceBits);
  while (slots_[at] != 0) at = (at + 1) & (slots_.size() - 1);
  slots_[at] = slot;
  ++used_;
}

// Doubles the table. One that is as large as it may be keeps half of its points instead.
void RepeatedPoints::make_space() {
  const bool may_grow = slots_.size() < most_;
  if (!may_grow) {
    ++sample_;
    count_ /= 2;
    near_ /= 2;
  }
  const std::vector<std::uint64_t> before =
      std::exchange(slots_, std::vector<std::uint64_t>(may_grow ? 2 * slots_.size() : slots_.size()));
  used_ = 0;
  for (const std::uint64_t slot : before) {
    if (slot != 0 && is_in_sample(slot >> kPlaceBits)) put(slot);
  }
}

}  // namespace lacuna::io
