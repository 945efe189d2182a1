// SPDX-License-Identifier: Apache-2.0
// Whether positions have the look of longitude and latitude.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <span>

#include <Eigen/Core>

namespace lacuna::io {

// Returns whether x and y may be degrees of one survey, in either order, with heights in a unit of length.
// This is a guess: lengths may look the same. All of these hold:
// - One of x and y is within 90, the other one within 360. Both extend over less than 3, and both have five
//   decimals or more. One of them is farther from 0 than ten times its extent.
// - z extends a hundred times as far as x and y. It is enough that z extends as far as they do, where it has
//   two decimals at most.
// Fewer than ten positions say nothing.
bool look_like_degrees(std::span<const Eigen::Vector3d> positions);

// Reads the first rows, at most 4,096.
bool look_like_degrees(ScanReader& reader);

}  // namespace lacuna::io
