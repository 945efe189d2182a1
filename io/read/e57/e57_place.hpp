// SPDX-License-Identifier: Apache-2.0
// Moves points and normals of an E57 scan from its own coordinates to the coordinates of the file.
#pragma once

#include "io/read/rows/pose.hpp"
#include "io/read/rows/scalar.hpp"

#include <array>
#include <cstddef>

namespace lacuna::io {

// A row begins with three doubles: the position, as it is in the scan.
struct E57Rows {
  std::byte* data;
  std::size_t stride;
  std::size_t count;
};

// Turns range, azimuth and elevation, the angles in radians, into x y z. The position is NaN if an angle is
// not finite or beyond 1e6. Returns the number of rows with an angle beyond a full turn. The bytes are equal
// on every machine. Error: 1e-15 times the range.
std::size_t spherical_to_cartesian(E57Rows rows);

// Moves positions by the pose. A point exactly at the scanner is a ray without a return, and becomes NaN.
void place_points(E57Rows rows, const Pose& pose);

// Turns normals by the pose; the columns are floats or doubles.
void turn_normals(std::array<Column, 3> normals, std::size_t count, const Pose& pose);

// Sets the position of each row with a state other than 0 to NaN: 1 is a direction alone, 2 nothing.
void drop_invalid(E57Rows rows, Column state);

}  // namespace lacuna::io
