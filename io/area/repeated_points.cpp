// SPDX-License-Identifier: Apache-2.0
#include "io/area/repeated_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace lacuna::io {
namespace {

std::uint64_t mixed(std::uint64_t bits) {  // splitmix64: Steele, Lea, Flood 2014
  bits += 0x9e3779b97f4a7c15;
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111eb;
  return bits ^ bits >> 31;
}

}  // namespace

RepeatedPoints::RepeatedPoints(double step, std::uint64_t memory)
    : steps_(1 / step), most_(std::bit_floor(std::max<std::uint64_t>(memory / 16, 1024))), slots_(1024) {}

bool RepeatedPoints::add(const Eigen::Vector3d& place, double time) {
  std::uint64_t hash = std::bit_cast<std::uint64_t>(time);
  for (const double value : place)
    hash = mixed(hash ^ std::bit_cast<std::uint64_t>(std::round(value * steps_) + 0.0));
  hash = std::max<std::uint64_t>(hash, 1);
  if ((hash & ((std::uint64_t{1} << sample_) - 1)) != 0) return false;
  if (!put(hash)) {
    ++count_;
    return true;
  }
  if (4 * used_ > 3 * slots_.size()) make_space();
  return false;
}

// Returns false if the hash was there.
bool RepeatedPoints::put(std::uint64_t hash) {
  std::size_t at = mixed(hash) & (slots_.size() - 1);
  for (; slots_[at] != 0; at = (at + 1) & (slots_.size() - 1)) {
    if (slots_[at] == hash) return false;
  }
  slots_[at] = hash;
  ++used_;
  return true;
}

// Doubles the table. One that is as large as it may be keeps half of its points instead.
void RepeatedPoints::make_space() {
  const bool may_grow = slots_.size() < most_;
  if (!may_grow) {
    ++sample_;
    count_ /= 2;
  }
  const std::vector<std::uint64_t> before =
      std::exchange(slots_, std::vector<std::uint64_t>(may_grow ? 2 * slots_.size() : slots_.size()));
  used_ = 0;
  for (const std::uint64_t hash : before) {
    if (hash != 0 && (hash & ((std::uint64_t{1} << sample_) - 1)) == 0) put(hash);
  }
}

}  // namespace lacuna::io
