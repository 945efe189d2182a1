// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_scale.hpp"

#include "engine/run/error.hpp"
#include "io/little_endian.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace lacuna::io {
namespace {

constexpr double kMost = 2147483647;  // of a stored coordinate
constexpr int kFinest = 6;            // powers of ten by which a scale may be divided
constexpr const char* kWayOut = "; --points-format ply holds them all";

// Rounded once, as a decimal number in a text is.
double power_of_ten(int exponent) {
  const std::string text = "1e" + std::to_string(exponent);
  double value = 1;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Returns the bounds of the points as the header says.
Eigen::AlignedBox3d bounds_of(const LasHeader& header) {
  Eigen::AlignedBox3d bounds;
  if (header.points == 0) return bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.max()[axis] = load<double>(&header.bytes[static_cast<std::size_t>(179 + 16 * axis)]);
    bounds.min()[axis] = load<double>(&header.bytes[static_cast<std::size_t>(187 + 16 * axis)]);
  }
  return bounds;
}

// An offset at a multiple of the scale from the first one.
std::optional<double> fitting_offset(double min, double max, double scale, double first) {
  if (!(min <= max)) return first;
  const auto fits = [&](double offset) {
    return std::max(std::abs(min - offset), std::abs(max - offset)) / scale <= kMost;
  };
  if (fits(first)) return first;
  const double moved = first + std::round((min / 2 + max / 2 - first) / scale) * scale;
  if (fits(moved) && las_step(scale, first, scale, moved)) return moved;
  return std::nullopt;
}

// Without any LAS file.
LasScale decimal_scale(const Eigen::AlignedBox3d& bounds) {
  if (bounds.isEmpty()) return {.scale = {0.001, 0.001, 0.001}, .offset = {0, 0, 0}};
  double extent = bounds.sizes().maxCoeff();
  if (!(extent > 0)) extent = std::max(bounds.min().cwiseAbs().maxCoeff(), 1e-3);
  const double step = power_of_ten(static_cast<int>(std::floor(std::log10(extent))));
  LasScale made;
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = bounds.min()[axis] / 2 + bounds.max()[axis] / 2;
    const double offset = std::round(middle / step) * step;
    made.offset.at(static_cast<std::size_t>(axis)) = offset;
    reach = std::max({reach, bounds.max()[axis] - offset, offset - bounds.min()[axis]});
  }
  const double least = std::max(reach / kMost, 1e-300);
  int exponent = static_cast<int>(std::floor(std::log10(least)));
  while (power_of_ten(exponent) < least) ++exponent;
  made.scale.fill(power_of_ten(exponent));
  return made;
}

}  // namespace

std::optional<LasStep> las_step(double scale, double offset, double to_scale, double to_offset) {
  constexpr double kClose = 1e-9, kCloseSteps = 1e-3;  // decimal numbers are not exact in binary
  const double factor = scale / to_scale, added = (offset - to_offset) / to_scale;
  const double whole = std::round(factor), whole_added = std::round(added);
  if (whole == 0 || std::abs(factor - whole) > kClose * std::abs(whole)) return std::nullopt;
  if (std::abs(added - whole_added) > kCloseSteps) return std::nullopt;
  if (!(std::abs(whole) <= kMost && std::abs(whole_added) < 1e18)) return std::nullopt;
  return LasStep{static_cast<std::int64_t>(whole), static_cast<std::int64_t>(whole_added)};
}

LasScale join_scales(const LasParts& parts) {
  std::vector<const LasPart*> fixed;  // those whose coordinates must stay exactly
  for (const LasPart& part : parts.las) {
    if (!part.has_pose) fixed.push_back(&part);
  }
  const bool has_others = !parts.imported.empty() || fixed.size() < parts.las.size();
  if (fixed.empty()) return decimal_scale(parts.bounds);
  LasScale made{.scale = fixed.front()->header.scale, .offset = fixed.front()->header.offset};
  const bool is_one = std::all_of(fixed.begin(), fixed.end(), [&](const LasPart* part) {
    return part->header.scale == made.scale && part->header.offset == made.offset;
  });
  if (is_one && !has_others) return made;

  Eigen::AlignedBox3d bounds = parts.bounds;
  for (const LasPart* part : fixed) bounds.extend(bounds_of(part->header));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double smallest = std::abs(made.scale[axis]);
    for (const LasPart* part : fixed) smallest = std::min(smallest, std::abs(part->header.scale[axis]));
    const double first = fixed.front()->header.offset[axis];
    bool is_exact = false;  // with some scale
    std::optional<double> offset;
    double scale = smallest;
    for (int i = 0; i <= kFinest && !offset; ++i) {
      scale = smallest / power_of_ten(has_others ? kFinest - i : i);
      const auto other = std::find_if(fixed.begin(), fixed.end(), [&](const LasPart* part) {
        return !las_step(part->header.scale[axis], part->header.offset[axis], scale, first);
      });
      if (other != fixed.end()) continue;
      is_exact = true;
      const auto at = static_cast<Eigen::Index>(axis);
      offset = fitting_offset(bounds.min()[at], bounds.max()[at], scale, first);
    }
    if (!is_exact) {
      const auto other = std::find_if(fixed.begin(), fixed.end(), [&](const LasPart* part) {
        return part->header.scale[axis] != fixed.front()->header.scale[axis] ||
               part->header.offset[axis] != first;
      });
      const LasPart& refused = other == fixed.end() ? *fixed.front() : **other;
      throw Error(refused.name + ": coordinates with a scale of " +
                  std::to_string(refused.header.scale[axis]) + " and an offset of " +
                  std::to_string(refused.header.offset[axis]) +
                  " cannot join those of the first file in one LAS file exactly" + kWayOut);
    }
    if (!offset)
      throw Error(fixed.front()->name + ": with its scale, one LAS file cannot hold coordinates from " +
                  std::to_string(bounds.min()[static_cast<Eigen::Index>(axis)]) + " to " +
                  std::to_string(bounds.max()[static_cast<Eigen::Index>(axis)]) + kWayOut);
    made.scale[axis] = scale;
    made.offset[axis] = *offset;
  }
  return made;
}

}  // namespace lacuna::io
