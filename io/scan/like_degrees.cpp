// SPDX-License-Identifier: Apache-2.0
#include "io/scan/like_degrees.hpp"

#include "io/rows/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace lacuna::io {
namespace {

constexpr std::size_t kMostRows = 4096, kFewestRows = 10;

bool are_within_degrees(const Eigen::Array3d& most) {
  return (most.x() <= 360 && most.y() <= 90) || (most.x() <= 90 && most.y() <= 360);
}

bool is_far_larger(std::span<const Eigen::Vector3d> positions) {
  constexpr double kSteeper = 1000, kSteeperFarAway = 100, kFarAway = 180;
  Eigen::Array3d steps = Eigen::Array3d::Zero();
  for (std::size_t i = 1; i < positions.size(); ++i) steps += (positions[i] - positions[i - 1]).array().abs();
  // A wall along an axis has no steps across it.
  if (steps.x() == 0 || steps.y() == 0) return false;
  const bool is_far_away = std::all_of(positions.begin(), positions.end(),
                                       [](const Eigen::Vector3d& p) { return std::abs(p.z()) > kFarAway; });
  return steps.z() > (is_far_away ? kSteeperFarAway : kSteeper) * (steps.x() + steps.y());
}

// Returns how many decimals all values of an axis have, as far as single precision shows them; 9 if more.
int decimals(std::span<const Eigen::Vector3d> positions, int axis) {
  constexpr int kMost = 9;
  for (int digits = 0; digits < kMost; ++digits) {
    const double steps = std::pow(10, digits);
    const bool are_whole = std::all_of(positions.begin(), positions.end(), [&](const Eigen::Vector3d& p) {
      const double value = p[axis], rounding = 6e-8 * std::abs(value) * steps + 1e-6;
      return rounding < 0.1 && std::abs(value * steps - std::round(value * steps)) <= rounding;
    });
    if (are_whole) return digits;
  }
  return kMost;
}

// Whether z is that of one plane, up to a hundredth of its variance.
bool is_plane(std::span<const Eigen::Vector3d> positions) {
  const auto rows = static_cast<Eigen::Index>(positions.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& position : positions) mean += position / static_cast<double>(rows);
  Eigen::MatrixX2d flat(rows, 2);
  Eigen::VectorXd z(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Vector3d offset = positions[static_cast<std::size_t>(i)] - mean;
    flat.row(i) = offset.head<2>();
    z[i] = offset.z();
  }
  const Eigen::Vector2d slope = flat.colPivHouseholderQr().solve(z);
  return (z - flat * slope).squaredNorm() <= 0.01 * z.squaredNorm();
}

// Whether the positions, seen from above, fill half of the squares over their bounds.
bool fill_their_bounds(std::span<const Eigen::Vector3d> positions, const Eigen::AlignedBox3d& box) {
  const auto edge = static_cast<std::size_t>(std::sqrt(static_cast<double>(positions.size()) / 4));
  const Eigen::Array2d sizes = box.sizes().head<2>().array().max(std::numeric_limits<double>::min());
  std::vector<char> squares(edge * edge);
  for (const Eigen::Vector3d& position : positions) {
    const Eigen::Array2d at =
        (position - box.min()).head<2>().array() / sizes * (static_cast<double>(edge) - 1e-6);
    squares[static_cast<std::size_t>(at.y()) * edge + static_cast<std::size_t>(at.x())] = 1;
  }
  const auto filled = static_cast<std::size_t>(std::count(squares.begin(), squares.end(), 1));
  const bool is_one_row = box.sizes().x() == 0 || box.sizes().y() == 0;
  return 2 * filled >= (is_one_row ? edge : squares.size());
}

bool is_far_smoother(std::span<const Eigen::Vector3d> positions) {
  constexpr std::size_t kFewest = 100, kQueries = 256;
  constexpr double kSteep = 3, kSteeper = 10, kSmooth = 0.15, kFewestSteps = 20, kRounding = 1e-9;
  if (positions.size() < kFewest) return false;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : positions) box.extend(position);
  const Eigen::Array2d sizes = box.sizes().head<2>().array();
  // A wall that was turned upright has only the rounding of its depth.
  const bool is_wall = sizes.minCoeff() > 0 && sizes.minCoeff() < kRounding * sizes.maxCoeff();
  if (is_wall || box.sizes().z() == 0 || !fill_their_bounds(positions, box)) return false;
  std::vector<double> far, high;  // from the nearest position, seen from above
  for (std::size_t i = 0; i < positions.size(); i += std::max<std::size_t>(1, positions.size() / kQueries)) {
    double nearest = std::numeric_limits<double>::infinity(), z = 0;
    for (const Eigen::Vector3d& other : positions) {
      const double square = (other - positions[i]).head<2>().squaredNorm();
      if (square >= nearest || other == positions[i]) continue;
      nearest = square;
      z = other.z();
    }
    far.push_back(std::sqrt(nearest));
    high.push_back(std::abs(z - positions[i].z()));
  }
  std::sort(far.begin(), far.end());
  std::sort(high.begin(), high.end());
  const double rise = high[high.size() / 2], run = far[far.size() / 2], height = box.sizes().z();
  if (run == 0 || high[high.size() * 3 / 4] > kSmooth * height) return false;
  const int digits = decimals(positions, 2);
  const bool are_finer = decimals(positions, 0) >= digits + 3 && decimals(positions, 1) >= digits + 3;
  const double step = std::pow(10, -digits);
  if (are_finer && step > 2 * run && height > kFewestSteps * step) return true;
  return rise > (are_finer ? kSteep : kSteeper) * run && !is_plane(positions);
}

}  // namespace

bool look_like_degrees(std::span<const Eigen::Vector3d> positions) {
  if (positions.size() < kFewestRows) return false;
  Eigen::Array3d most = Eigen::Array3d::Zero();
  for (const Eigen::Vector3d& position : positions) most = most.max(position.array().abs());
  return are_within_degrees(most) && (is_far_larger(positions) || is_far_smoother(positions));
}

bool look_like_degrees(ScanReader& reader) {
  RowBatch rows;
  std::vector<Eigen::Vector3d> positions;
  if (!reader.next(rows, kMostRows)) return false;
  load_vectors(rows, reader.layout(), kPositionNames, positions);
  std::erase_if(positions, [](const Eigen::Vector3d& position) { return !position.allFinite(); });
  return look_like_degrees(positions);
}

}  // namespace lacuna::io
