// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/e57_place.hpp"

#include "engine/simd/maths.hpp"
#include "io/read/files/little_endian.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace lacuna::io {
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
