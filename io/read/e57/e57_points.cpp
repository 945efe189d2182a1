// SPDX-License-Identifier: Apache-2.0
#include "engine/simd/maths.hpp"
#include "io/read/e57/e57.hpp"
#include "io/read/files/number.hpp"

#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace lacuna::io {
namespace {

constexpr std::size_t kSectionHeader = 32, kPacketHeader = 4, kDataHeader = 6, kMostPadding = 3;
constexpr std::size_t kMostHeld = std::size_t{8} << 20;

enum PacketType : std::uint8_t { kIndex = 0, kData = 1, kEmpty = 2 };

constexpr std::size_t kPadding = 8;

// Returns `bits` bits, 1 to 64, from any bit on. Loads up to 9 bytes.
std::uint64_t bits_at(const std::byte* bytes, std::uint64_t first, unsigned bits) {
  const std::byte* const at = bytes + first / 8;
  const unsigned shift = first % 8;
  std::uint64_t value = load<std::uint64_t>(at) >> shift;
  if (shift + bits > 64) value |= std::to_integer<std::uint64_t>(at[8]) << (64 - shift);
  return value & ~std::uint64_t{0} >> (64 - bits);
}

// Stores a value for each of `count` rows, by its rank.
template <class ValueOf>
void fill(Column to, std::size_t count, const ValueOf& value_of) {
  with_type(to.type, [&](auto zero) {
    for (std::size_t i = 0; i < count; ++i) {
      store(to.data + i * to.stride, static_cast<decltype(zero)>(value_of(i)));
    }
  });
}

}  // namespace

std::size_t FieldStream::ready(std::size_t most) const {
  if (field_.bits == 0) return most;
  return static_cast<std::size_t>(std::min<std::uint64_t>(most, held_bits() / field_.bits));
}

void FieldStream::append(std::span<const std::byte> bytes) {
  if (field_.bits == 0) return;  // nothing takes them
  const auto taken = static_cast<std::size_t>(begin_bit_ / 8);
  const std::size_t kept = end_ - taken;
  if (taken >= kept) {  // so that each byte is moved once on average
    if (kept > 0) std::memmove(bytes_.data(), bytes_.data() + taken, kept);
    begin_bit_ %= 8;
    end_ = kept;
  }
  bytes_.resize(std::max(bytes_.size(), end_ + bytes.size() + kPadding));
  if (!bytes.empty()) std::memcpy(bytes_.data() + end_, bytes.data(), bytes.size());
  end_ += bytes.size();
}

void FieldStream::take(std::size_t count, Column to, std::int64_t added) {
  assert(ready(count) == count);
  const std::byte* const bytes = bytes_.data();
  const auto whole = [&](std::size_t i) {
    const std::uint64_t stored =
        field_.bits == 0 ? 0 : bits_at(bytes, begin_bit_ + i * field_.bits, field_.bits);
    // Unsigned sums cannot overflow, whatever the limits are.
    return static_cast<std::int64_t>(stored + static_cast<std::uint64_t>(field_.minimum) +
                                     static_cast<std::uint64_t>(added));
  };
  switch (field_.type) {
    case E57Field::Type::kFloat32:
      fill(to, count, [&](std::size_t i) { return load<float>(bytes + begin_bit_ / 8 + i * sizeof(float)); });
      break;
    case E57Field::Type::kFloat64:
      fill(to, count,
           [&](std::size_t i) { return load<double>(bytes + begin_bit_ / 8 + i * sizeof(double)); });
      break;
    case E57Field::Type::kInteger:
      fill(to, count, whole);
      break;
    case E57Field::Type::kScaledInteger:
      fill(to, count,
           [&](std::size_t i) { return static_cast<double>(whole(i)) * field_.scale + field_.offset; });
      break;
  }
  begin_bit_ += count * std::uint64_t{field_.bits};
}

E57Points::E57Points(PagedFile& pages, const E57Scan& scan, std::size_t number)
    : pages_(pages), number_(number), records_(scan.records), left_(scan.records) {
  for (const E57Field& field : scan.fields) streams_.emplace_back(field);
  const std::string name = "the points of scan " + std::to_string(number);
  pages_.seek(scan.points_at, name);
  const std::uint64_t begin = pages_.position();
  std::array<std::byte, kSectionHeader> head;
  pages_.read(head.data(), head.size());
  if (load<std::uint8_t>(head.data()) != 1) {
    fail(begin, "its points begin with " + std::to_string(load<std::uint8_t>(head.data())) +
                    "; 1 is needed, the mark of a section of points");
  }
  const auto length = load<std::uint64_t>(&head[8]);
  if (length < kSectionHeader || length > pages_.size() - begin) {
    fail(begin, "the section of its points has " + std::to_string(length) + " bytes; 32 to " +
                    std::to_string(pages_.size() - begin) + " are possible here");
  }
  const auto packets_at = load<std::uint64_t>(&head[16]);
  end_ = records_ == 0 && packets_at == 0 ? pages_.position() : begin + length;
  if (end_ == pages_.position()) return;  // no packets of no points
  pages_.seek(packets_at, name);
  if (pages_.position() < begin + kSectionHeader || pages_.position() > end_) {
    fail(begin, "its first packet is not in the section of its points");
  }
}

std::size_t E57Points::ready(std::size_t most) {
  for (;;) {
    auto count = static_cast<std::size_t>(std::min<std::uint64_t>(most, left_));
    for (const FieldStream& stream : streams_) count = stream.ready(count);
    if (count > 0 || left_ == 0) return count;
    read_packet();
  }
}

bool E57Points::holds_more() const {
  return std::ranges::any_of(streams_, &FieldStream::holds_more) &&
         std::ranges::all_of(streams_, [](const FieldStream& stream) { return stream.ready(1) == 1; });
}

void E57Points::require_end() {
  while (!holds_more()) {
    if (end_ - pages_.position() < kPacketHeader) return;
    read_packet();
  }
  fail_more();
}

void E57Points::fail_more() const {
  fail(pages_.position(), "its packets hold more than the " + std::to_string(records_) +
                              " points of its recordCount; --trust header reads these alone");
}

void E57Points::read_packet() {
  const std::uint64_t place = pages_.position();
  if (end_ - place < kPacketHeader) {
    fail(place, "its packets end here, " + std::to_string(left_) + " points too early");
  }
  packet_.resize(kPacketHeader);
  pages_.read(packet_.data(), kPacketHeader);
  const auto type = load<std::uint8_t>(packet_.data());
  const std::size_t bytes = load<std::uint16_t>(&packet_[2]) + std::size_t{1};
  if (type > kEmpty) {
    fail(place, "a packet of type " + std::to_string(type) + "; known are 0 to 2");
  }
  if (bytes < kPacketHeader || bytes > end_ - place) {
    fail(place, "a packet of " + std::to_string(bytes) + " bytes; 4 to " + std::to_string(end_ - place) +
                    " are possible here");
  }
  if (type == kData) {
    read_data(place, bytes);
  } else {
    pages_.skip(bytes - kPacketHeader);
  }
}

void E57Points::read_data(std::uint64_t place, std::size_t bytes) {
  packet_.resize(bytes);
  pages_.read(packet_.data() + kPacketHeader, bytes - kPacketHeader);
  const std::size_t fields = bytes < kDataHeader ? 0 : load<std::uint16_t>(&packet_[kPacketHeader]);
  if (records_ == 0 && bytes > kDataHeader + 2 * fields + kMostPadding) fail_more();
  if (records_ == 0) return;
  if (fields != streams_.size()) {
    fail(place, "a packet of " + std::to_string(fields) + " fields; its points have " +
                    std::to_string(streams_.size()));
  }
  std::size_t at = kDataHeader + 2 * fields;
  std::size_t held = 0;
  for (std::size_t i = 0; i < fields; ++i) {
    const std::size_t length =
        at > bytes ? bytes : load<std::uint16_t>(&packet_[kDataHeader + 2 * i]);  // fails below
    if (at + length > bytes) {
      fail(place, "the fields of a packet are longer than its " + std::to_string(bytes) + " bytes");
    }
    streams_[i].append(std::span(packet_).subspan(at, length));
    at += length;
    held += streams_[i].held_bytes();
  }
  if (held > kMostHeld) {
    fail(place, "values of the same point are too far apart; up to " + std::to_string(kMostHeld) +
                    " bytes may be between them");
  }
}

void E57Points::fail(std::uint64_t place, const std::string& reason) const {
  pages_.fail(place, "scan " + std::to_string(number_) + ": " + reason);
}

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Direction {
  double cosine, sine;
};

Direction direction(double angle) {
  constexpr double kLargest = 1e6;
  if (!(std::abs(angle) <= kLargest)) return {kNan, kNan};
  // pi / 2 in two parts: the first has zeros at its end, so that its product with `quarters` is exact.
  constexpr double kHigh = 0x1.921fb544p0, kLow = 0x1.0b4611a626331p-34;
  const double quarters = std::nearbyint(angle / (std::numbers::pi / 2));
  const double rest = (angle - quarters * kHigh) - quarters * kLow;  // at most pi / 4, either way
  const double c = cosine(std::abs(rest));
  const double s = std::copysign(cosine(std::numbers::pi / 2 - std::abs(rest)), rest);
  switch (static_cast<long>(quarters) & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

template <class Change>
void for_each_position(E57Rows rows, const Change& change) {
  for (std::size_t i = 0; i < rows.count; ++i) {
    std::byte* const at = rows.data + i * rows.stride;
    Eigen::Vector3d position;
    std::memcpy(position.data(), at, sizeof position);
    position = change(position);
    std::memcpy(at, position.data(), sizeof position);
  }
}

double value_at(Column column, std::size_t row) {
  double value;
  copy_column(
      {.data = column.data + row * column.stride, .stride = 0, .type = column.type},
      {.data = reinterpret_cast<std::byte*>(&value), .stride = sizeof value, .type = Scalar::kFloat64}, 1);
  return value;
}

}  // namespace

std::size_t spherical_to_cartesian(E57Rows rows) {
  constexpr double kTurn = 2 * std::numbers::pi * 1.001;
  std::size_t wide = 0;
  for_each_position(rows, [&](const Eigen::Vector3d& ray) {
    wide += ray.tail<2>().cwiseAbs().maxCoeff() > kTurn ? 1 : 0;
    const Direction azimuth = direction(ray[1]), elevation = direction(ray[2]);
    return Eigen::Vector3d(ray[0] * elevation.cosine * azimuth.cosine,
                           ray[0] * elevation.cosine * azimuth.sine, ray[0] * elevation.sine);
  });
  return wide;
}

void place_points(E57Rows rows, const Pose& pose) {
  for_each_position(rows, [&](const Eigen::Vector3d& own) -> Eigen::Vector3d {
    if (own.isZero(0)) return Eigen::Vector3d::Constant(kNan);
    return pose * own;
  });
}

void turn_normals(std::array<Column, 3> normals, std::size_t count, const Pose& pose) {
  if (pose.linear() == Eigen::Matrix3d::Identity()) return;
  for (std::size_t row = 0; row < count; ++row) {
    const Eigen::Vector3d normal =
        pose.linear() *
        Eigen::Vector3d(value_at(normals[0], row), value_at(normals[1], row), value_at(normals[2], row));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::byte* const to = normals[axis].data + row * normals[axis].stride;
      const double component = normal[static_cast<Eigen::Index>(axis)];
      if (normals[axis].type == Scalar::kFloat32) {
        store(to, static_cast<float>(component));
      } else {
        store(to, component);
      }
    }
  }
}

void drop_invalid(E57Rows rows, Column state) {
  with_type(state.type, [&](auto zero) {
    for (std::size_t i = 0; i < rows.count; ++i) {
      if (load<decltype(zero)>(state.data + i * state.stride) == zero) continue;
      constexpr std::array kNone = {kNan, kNan, kNan};
      std::memcpy(rows.data + i * rows.stride, kNone.data(), sizeof kNone);
    }
  });
}

}  // namespace lacuna::io
