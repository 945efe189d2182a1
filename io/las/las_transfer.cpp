// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_transfer.hpp"

#include "engine/run/error.hpp"
#include "io/las/las_fields.hpp"
#include "io/little_endian.hpp"
#include "io/property_name.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::size_t kCoordinates = 12;  // bytes
constexpr std::uint8_t kFloat = 9, kDouble = 10;

unsigned bits(const std::byte* from, std::size_t at, unsigned shift, unsigned count) {
  return std::to_integer<unsigned>(from[at]) >> shift & ((1u << count) - 1);
}

// The fields of formats 0 to 5 behind the coordinates, as formats 6 to 10 have them. Overlap is a flag there,
// and its class reserved (LAS 1.4 R15, table 17).
void widen_core(const std::byte* from, std::byte* to) {
  constexpr double kStep = 0.006;  // degrees
  constexpr unsigned kOverlapClass = 12, kUnclassified = 1, kOverlapFlag = 8;
  const unsigned given = bits(from, 15, 0, 5);
  const bool is_overlap = given == kOverlapClass;
  std::memcpy(to + 12, from + 12, 2);  // intensity
  to[14] = static_cast<std::byte>(bits(from, 14, 0, 3) | bits(from, 14, 3, 3) << 4);
  to[15] = static_cast<std::byte>(bits(from, 15, 5, 3) | (is_overlap ? kOverlapFlag : 0u) |
                                  bits(from, 14, 6, 2) << 6);
  to[16] = static_cast<std::byte>(is_overlap ? kUnclassified : given);
  to[17] = from[17];  // user data
  const double degrees = load<std::int8_t>(from + 16);
  store(to + 18, static_cast<std::int16_t>(std::lround(degrees / kStep)));
  std::memcpy(to + 20, from + 18, 2);  // point source
}

bool is_single_float(const LasExtraBytes& extra) {
  return (extra.type == kFloat || extra.type == kDouble) && extra.scale == 1 && extra.offset == 0;
}

}  // namespace

LasTransfer::LasTransfer(std::string name, const LasHeader& from, const LasForm& to,
                         std::optional<Eigen::Affine3d> pose)
    : name_(std::move(name)),
      record_bytes_(from.record_bytes),
      from_scale_(from.scale),
      from_offset_(from.offset),
      scale_(to.scale),
      offset_(to.offset),
      pose_(std::move(pose)),
      empty_(to.record_bytes) {
  const bool is_same = from.scale == to.scale && from.offset == to.offset;
  if (!pose_ && is_same) copy(0, 0, kCoordinates);
  if (!pose_ && !is_same) {
    is_stepped_ = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto step = las_step(from.scale[axis], from.offset[axis], to.scale[axis], to.offset[axis]);
      if (!step) throw Error(name_ + ": its header has changed during the run; it must stay as it is");
      steps_[axis] = *step;
    }
  }
  is_widened_core_ = is_extended_format(to.point_format) && !is_extended_format(from.point_format);
  if (!is_widened_core_)
    copy(kCoordinates, kCoordinates, (is_extended_format(to.point_format) ? 22 : 20) - kCoordinates);
  const LasGroups own = las_groups(from.point_format), shared = las_groups(to.point_format);
  const auto copy_group = [&](const std::optional<std::size_t>& source,
                              const std::optional<std::size_t>& target, std::size_t bytes) {
    if (source && target) copy(*source, *target, bytes);
  };
  copy_group(own.gps_time, shared.gps_time, kLasTimeBytes);
  copy_group(own.colour, shared.colour, kLasColourBytes);
  copy_group(own.infrared, shared.infrared, kLasInfraredBytes);
  copy_group(own.waveform, shared.waveform, kLasWaveformBytes);
  find_extra(from, to);
  if (pose_) find_normals(to);
  is_whole_ = copies_.size() == 1 && copies_.front().to == 0 && copies_.front().bytes == to.record_bytes;
}

void LasTransfer::copy(std::size_t from, std::size_t to, std::size_t bytes) {
  if (!copies_.empty()) {
    Copy& last = copies_.back();
    if (last.from + last.bytes == from && last.to + last.bytes == to) {
      last.bytes += bytes;
      return;
    }
  }
  copies_.push_back({from, to, bytes});
}

void LasTransfer::find_extra(const LasHeader& from, const LasForm& to) {
  std::set<std::size_t> found;
  std::size_t at = las_point_bytes(from.point_format);
  for (const LasExtraBytes& extra : las_extra_of_points(from)) {
    const std::size_t bytes = las_extra_size(extra), place = std::exchange(at, at + bytes);
    if (is_lacuna_extra(extra) && !to.keeps_results) continue;
    std::size_t i = 0;
    while (i < to.extra.size() && (to.extra[i].what.name != extra.name || found.contains(i))) ++i;
    if (i == to.extra.size()) continue;
    found.insert(i);
    const LasExtraField& field = to.extra[i];
    if (is_same_kind(field.what, extra)) {
      copy(place, field.offset, bytes);
    } else {
      widened_.push_back({extra.type, extra.scale, extra.offset, las_no_data(extra), place, field.offset});
    }
  }
  for (std::size_t i = 0; i < to.extra.size(); ++i) {
    if (found.contains(i)) continue;
    const std::vector<std::byte> missing = las_extra_missing(to.extra[i].what);
    std::copy(missing.begin(), missing.end(),
              empty_.begin() + static_cast<std::ptrdiff_t>(to.extra[i].offset));
  }
}

void LasTransfer::find_normals(const LasForm& to) {
  for (const char* name : {"nx", "ny", "nz"}) {
    for (const LasExtraField& field : to.extra) {
      if (known_name(field.what.name) == name && is_single_float(field.what))
        normals_.push_back({field.offset, field.what.type});
    }
  }
  if (normals_.size() != 3) normals_.clear();
}

void LasTransfer::convert(std::span<const std::byte> records, std::size_t stride, std::byte* out) const {
  for (; !records.empty(); records = records.subspan(record_bytes_), out += stride) {
    const std::byte* const from = records.data();
    if (!is_whole_) std::memcpy(out, empty_.data(), empty_.size());
    for (const Copy& part : copies_) std::memcpy(out + part.to, from + part.from, part.bytes);
    if (is_whole_) continue;
    if (is_widened_core_) widen_core(from, out);
    for (const Widen& value : widened_) {
      const double stored = load_las_value(value.type, from + value.from);
      const bool is_missing = stored == value.no_data;
      store(out + value.to,
            is_missing ? std::numeric_limits<double>::quiet_NaN() : stored * value.scale + value.added);
    }
    if (is_stepped_ || pose_) move(from, out);
    if (!normals_.empty()) turn(out);
  }
}

void LasTransfer::move(const std::byte* from, std::byte* to) const {
  Eigen::Vector3d position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = load<std::int32_t>(from + 4 * axis);
    if (pose_) {
      position[static_cast<Eigen::Index>(axis)] = value * from_scale_[axis] + from_offset_[axis];
      continue;
    }
    // Within 2^31 (2^31 + 1) + 10^18.
    const std::int64_t moved = value * steps_[axis].factor + steps_[axis].added;
    if (moved < std::numeric_limits<std::int32_t>::min() || moved > std::numeric_limits<std::int32_t>::max())
      fail_range();
    store(to + 4 * axis, static_cast<std::int32_t>(moved));
  }
  if (!pose_) return;
  position = *pose_ * position;
  for (std::size_t axis = 0; axis < 3; ++axis)
    store(to + 4 * axis, stored(position[static_cast<Eigen::Index>(axis)], axis));
}

std::int32_t LasTransfer::stored(double value, std::size_t axis) const {
  const double steps = std::round((value - offset_[axis]) / scale_[axis]);
  if (!(std::abs(steps) <= std::numeric_limits<std::int32_t>::max())) fail_range();
  return static_cast<std::int32_t>(steps);
}

void LasTransfer::turn(std::byte* record) const {
  Eigen::Vector3d normal;
  for (std::size_t i = 0; i < 3; ++i)
    normal[static_cast<Eigen::Index>(i)] = load_las_value(normals_[i].type, record + normals_[i].at);
  normal = pose_->linear() / std::cbrt(pose_->linear().determinant()) * normal;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = normal[static_cast<Eigen::Index>(i)];
    if (normals_[i].type == kFloat) {
      store(record + normals_[i].at, static_cast<float>(value));
    } else {
      store(record + normals_[i].at, value);
    }
  }
}

void LasTransfer::fail_range() const {
  throw Error(name_ +
              ": a point lies outside the bounds in the header, and its coordinates do not fit those of " +
              "the other files in one LAS file; --points-format ply holds them all");
}

}  // namespace lacuna::io
