// SPDX-License-Identifier: Apache-2.0
// From a file's own coordinates to the scan's: by a pose, an offset, or another unit of z.
#pragma once

#include "engine/export.hpp"
#include "io/read/files/input_file.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna::io {

class ScanReader;

// The pose of a scan in the registered scan: a rotation, a scale and a translation.

using Pose = Eigen::Affine3d;  // of the scan's own coordinates: p -> A p + t

// Returns the pose of a matrix. Throws `Error` unless the matrix only turns, scales evenly and moves (to 1
// part in 1000).
Pose pose_of(const Eigen::Matrix4d& matrix);

// Reads numbers divided by blanks or commas. 16 are a 4 x 4 matrix, row by row, and 12 its first three rows.
// 7 are the translation x y z and the unit quaternion x y z w. Throws `Error` where `pose_of` does.
LACUNA_API Pose parse_pose(std::string_view numbers);

// Reads the numbers from a text file, over any number of lines. Throws `Error`.
LACUNA_API Pose read_pose(const std::filesystem::path& file);

// Local coordinates are relative to an offset. A comment in the header of a PLY file states it:
// "lacuna offset X Y Z". The coordinates of the scan are the sums.

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

// A file with coordinates of its own, read in the coordinates of the scan.

// Returns the rows of `reader`, a PLY file, with the offset added to their positions, which become doubles.
// Places of scanners have the offset already. Returns `reader` itself without an offset.
std::unique_ptr<ScanReader> with_offset(std::unique_ptr<ScanReader> reader, const LocalOffset& offset);

// Returns the rows of `reader` with their positions moved by the pose, and their normals turned. Positions
// and normals become doubles; all else stays as it is.
std::unique_ptr<ScanReader> posed(std::unique_ptr<ScanReader> reader, const Pose& pose);

// Returns the rows of `reader` with z in another unit, a multiple of it. Normals stay at right angles to the
// surface, but need not have unit length.
std::unique_ptr<ScanReader> with_z_times(std::unique_ptr<ScanReader> reader, double factor);

}  // namespace lacuna::io
