// SPDX-License-Identifier: Apache-2.0
// The pose of a scan in the registered scan: a rotation, a scale and a translation.
#pragma once

#include "engine/export.hpp"

#include <filesystem>
#include <string_view>

#include <Eigen/Geometry>

namespace lacuna::io {

using Pose = Eigen::Affine3d;  // of the scan's own coordinates: p -> A p + t

// Returns the pose of a matrix. Throws `Error` unless the matrix only turns, scales evenly and moves (to 1
// part in 1000).
Pose pose_of(const Eigen::Matrix4d& matrix);

// Reads numbers divided by blanks or commas. 16 are a 4 x 4 matrix, row by row, and 12 its first three rows.
// 7 are the translation x y z and the unit quaternion x y z w. Throws `Error` where `pose_of` does.
LACUNA_API Pose parse_pose(std::string_view numbers);

// Reads the numbers from a text file, over any number of lines. Throws `Error`.
LACUNA_API Pose read_pose(const std::filesystem::path& file);

}  // namespace lacuna::io
