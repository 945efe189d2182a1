// SPDX-License-Identifier: Apache-2.0
// Whether positions can only be longitude and latitude, with heights in units of length.
#pragma once

#include "io/rows/scan_reader.hpp"

#include <span>

#include <Eigen/Core>

namespace lacuna::io {

// Takes up to 4,096 positions that follow one another in a file. Fewer than ten say nothing. One of x and y
// is within 90 and the other within 360. Besides, one of two rules holds:
//
// - From row to row, z changes a thousand times as much as x and y. A hundred times is enough where z is
// beyond
//   180 everywhere.
// - z is a smooth function of x and y, and rises by more than 10 units in each, but is not that of one plane.
//   A rise of 3 is enough where x and y have three decimals more than z. Any rise is, if z has then steps of
//   more than twice the distance to the next point. A steep surface that was sampled in true lengths has
//   several z at most places, or lies in a narrow strip.
bool look_like_degrees(std::span<const Eigen::Vector3d> positions);

// Reads the first rows.
bool look_like_degrees(ScanReader& reader);

}  // namespace lacuna::io
