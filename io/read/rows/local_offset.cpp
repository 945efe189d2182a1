// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/local_offset.hpp"

#include "io/read/files/number.hpp"
#include "io/read/rows/vectors.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace lacuna::io {

std::optional<double> component_of(const LocalOffset& offset, std::string_view column) {
  const auto axis = std::find(kPositionNames.begin(), kPositionNames.end(), column);
  if (!offset || axis == kPositionNames.end()) return std::nullopt;
  return (*offset)[axis - kPositionNames.begin()];
}

std::string print_offset(const Eigen::Vector3d& offset) {
  std::string text = "lacuna offset";
  for (const double number : offset) {
    std::array<char, 400> digits;  // as many as a double may have before its point, and more
    const auto [end, status] = std::to_chars(digits.begin(), digits.end(), number, std::chars_format::fixed);
    text.append(" ").append(digits.begin(), end);
  }
  return text;
}

void read_offset(const InputFile& in, std::span<const std::string_view> comment, LocalOffset& offset) {
  if (comment.size() < 2 || comment[0] != "lacuna" || comment[1] != "offset") return;
  if (offset) in.fail_at_line(in.line(), "a second 'lacuna offset'; one is allowed");
  Eigen::Vector3d numbers;
  bool is_known = comment.size() == kOffsetWords;
  for (std::size_t i = 2; is_known && i < kOffsetWords; ++i) {
    double& number = numbers[static_cast<Eigen::Index>(i - 2)];
    is_known = parse_number(comment[i], number) && std::isfinite(number);
  }
  if (!is_known) in.fail_at_line(in.line(), "'lacuna offset X Y Z' with three numbers expected");
  offset = numbers;
}

}  // namespace lacuna::io
