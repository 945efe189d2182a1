// SPDX-License-Identifier: Apache-2.0
// Local coordinates are relative to an offset. A comment in the header of a PLY file states it:
// "lacuna offset X Y Z". The coordinates of the scan are the sums.
#pragma once

#include "io/read/files/input_file.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace lacuna::io {

using LocalOffset = std::optional<Eigen::Vector3d>;  // empty if the file has the coordinates of the scan

// Returns its component along a column's coordinate. Returns nothing for other columns, and without an
// offset.
std::optional<double> component_of(const LocalOffset& offset, std::string_view column);

inline constexpr std::size_t kOffsetWords = 5;  // of that comment

// Returns the comment without the sign that marks it as a comment. Reading it gives the same numbers.
std::string print_offset(const Eigen::Vector3d& offset);

// Sets `offset` if the words of a comment state one. Throws `Error` with the line if it is not three finite
// numbers, or is the second one.
void read_offset(const InputFile& in, std::span<const std::string_view> comment, LocalOffset& offset);

}  // namespace lacuna::io
