// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/pose.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace lacuna::io {
namespace {

constexpr double kTolerance = 1e-3;
constexpr std::size_t kLargestPoseFile = 1 << 16;

std::vector<double> parse_numbers(std::string_view text) {
  constexpr std::string_view kBetween = ", \t\r\n";
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(kBetween); at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (!parse_number(word, numbers.emplace_back()) || !std::isfinite(numbers.back()))
      throw Error(in_quotes(word) + " is no number of a pose");
    at = text.find_first_not_of(kBetween, end);
  }
  return numbers;
}

Pose from_quaternion(const std::vector<double>& numbers) {
  const Eigen::Quaterniond turn(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (std::abs(turn.norm() - 1) > kTolerance)
    throw Error("the quaternion of a pose has length " + std::to_string(turn.norm()) +
                "; allowed: translation x y z, then a unit quaternion x y z w");
  Pose pose(turn.normalized());
  pose.pretranslate(Eigen::Vector3d(numbers[0], numbers[1], numbers[2]));
  return pose;
}

// Reads the matrix from its first rows, or from all of them.
Eigen::Matrix4d matrix_of(const std::vector<double>& numbers) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = numbers[i];
  return matrix;
}

}  // namespace

Pose pose_of(const Eigen::Matrix4d& matrix) {
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw Error("the last row of a pose is not 0 0 0 1; the matrix may be transposed");
  const Pose pose(matrix);
  const Eigen::Matrix3d square = pose.linear().transpose() * pose.linear();
  const double scale = square.trace() / 3;
  const bool is_even = (square - scale * Eigen::Matrix3d::Identity()).norm() <= kTolerance * scale;
  if (!is_even || !(pose.linear().determinant() > 0))
    throw Error("the matrix of a pose does not turn the scan; it shears, mirrors or flattens it");
  return pose;
}

Pose parse_pose(std::string_view text) {
  const std::vector<double> numbers = parse_numbers(text);
  if (numbers.size() != 7 && numbers.size() != 12 && numbers.size() != 16)
    throw Error(
        "a pose of " + std::to_string(numbers.size()) +
        " numbers; allowed: 16 (a 4 x 4 matrix), 12 (its first rows), or 7 (x y z, quaternion x y z w)");
  if (numbers.size() == 7) return from_quaternion(numbers);
  return pose_of(matrix_of(numbers));
}

Pose read_pose(const std::filesystem::path& file) {
  InputFile in(file);
  if (in.remaining() > kLargestPoseFile) in.fail("too large for a pose of 16 numbers");
  std::string text(in.remaining(), '\0');
  in.read(reinterpret_cast<std::byte*>(text.data()), text.size());
  try {
    return parse_pose(text);
  } catch (const Error& error) {
    in.fail(error.what());
  }
}

}  // namespace lacuna::io
