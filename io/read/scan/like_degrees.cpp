// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/like_degrees.hpp"

#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

// Whether all values of an axis are multiples of the step, as far as single precision shows it.
bool are_in_steps(std::span<const Eigen::Vector3d> positions, int axis, double step) {
  return std::ranges::all_of(positions, [&](const Eigen::Vector3d& position) {
    const double steps = position[axis] / step;
    return std::abs(steps - std::round(steps)) <= 6e-8 * std::abs(steps) + 1e-6;
  });
}

}  // namespace

bool look_like_degrees(std::span<const Eigen::Vector3d> positions) {
  constexpr std::size_t kFewest = 10;
  constexpr double kWidest = 3, kFarther = 10, kHigher = 100, kFourDecimals = 1e-4, kTwoDecimals = 1e-2;
  if (positions.size() < kFewest) return false;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : positions) box.extend(position);
  const Eigen::Array3d sizes = box.sizes(), most = box.min().array().abs().max(box.max().array().abs());
  const double widest = sizes.head<2>().maxCoeff();
  const bool are_in_range = most.head<2>().minCoeff() <= 90 && most.head<2>().maxCoeff() <= 360;
  const bool is_one_far = (most.head<2>() > (kFarther + 1) * sizes.head<2>()).any();
  if (!are_in_range || widest > kWidest || !is_one_far || sizes.z() < widest) return false;
  if (are_in_steps(positions, 0, kFourDecimals) || are_in_steps(positions, 1, kFourDecimals)) return false;
  return sizes.z() > kHigher * widest || are_in_steps(positions, 2, kTwoDecimals);
}

bool look_like_degrees(ScanReader& reader) {
  constexpr std::size_t kRows = 4096;
  RowBatch rows;
  std::vector<Eigen::Vector3d> positions;
  if (!reader.next(rows, kRows)) return false;
  load_vectors(rows, reader.layout(), kPositionNames, positions);
  std::erase_if(positions, [](const Eigen::Vector3d& position) { return !position.allFinite(); });
  return look_like_degrees(positions);
}

}  // namespace lacuna::io
