// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/z_curve.hpp"

#include <algorithm>
#include <bit>

namespace lacuna {
namespace {

constexpr double kSteps = 0x1p62;

// The highest bit in which places differ: axis x before y before z among equal ones. The bit is 0 where no
// bit differs.
struct Difference {
  std::size_t axis = 0;
  std::uint64_t bit = 0;
};

Difference difference(const ZPlace& a, const ZPlace& b) {
  Difference highest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint64_t bit = std::bit_floor(a[axis] ^ b[axis]);
    if (bit > highest.bit) highest = {axis, bit};
  }
  return highest;
}

void cut(std::span<const ZPlace> places, std::size_t first, std::size_t last, std::size_t most,
         std::vector<std::uint32_t>& ends) {
  if (last - first <= most) {
    ends.push_back(static_cast<std::uint32_t>(last));
    return;
  }
  const auto [axis, bit] = difference(places[first], places[last - 1]);
  std::size_t middle = first + most;  // at one place
  if (bit != 0) {
    const auto begin = places.begin();
    const auto in_first_half = [axis = axis, bit = bit](const ZPlace& place) {
      return (place[axis] & bit) == 0;
    };
    middle = static_cast<std::size_t>(std::partition_point(begin + static_cast<std::ptrdiff_t>(first),
                                                           begin + static_cast<std::ptrdiff_t>(last),
                                                           in_first_half) -
                                      begin);
  }
  cut(places, first, middle, most, ends);
  cut(places, middle, last, most, ends);
}

}  // namespace

ZCurve::ZCurve(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return;
  low_ = box.min();
  const double extent = box.sizes().maxCoeff();
  if (extent > 0) scale_ = kSteps / extent;
}

ZPlace ZCurve::place(const Eigen::Vector3d& point) const {
  ZPlace place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    const double steps = (point[at] - low_[at]) * scale_;
    if (steps > 0) place[axis] = static_cast<std::uint64_t>(std::min(steps, kSteps));  // not a number: 0
  }
  return place;
}

bool comes_before(const ZPlace& a, const ZPlace& b) {
  const auto [axis, bit] = difference(a, b);
  return (b[axis] & bit) != 0;
}

std::vector<std::uint32_t> cut_runs(std::span<const ZPlace> places, std::size_t most) {
  std::vector<std::uint32_t> ends;
  if (!places.empty()) cut(places, 0, places.size(), most, ends);
  return ends;
}

}  // namespace lacuna
