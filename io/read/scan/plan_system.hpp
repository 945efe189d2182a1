// SPDX-License-Identifier: Apache-2.0
// What x and y are: longitude and latitude, a plan and where on Earth it lies, or neither.
#pragma once

#include "io/read/rows/scan_reader.hpp"
#include "io/read/scan/scan_files.hpp"

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

namespace lacuna::io {

// Whether positions have the look of longitude and latitude.

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

// Whether x and y of a scan are its plan, and where on Earth it lies.

// Returns a position of a file that is likely to be one of its surface; nothing if its first rows have none.
std::optional<Eigen::Vector3d> find_place(const ScanFiles& scan, std::size_t file);

// Returns the system in which the user can work instead, such as "EPSG:32632".
std::string utm_zone(double longitude, double latitude);

// Throws `Error` where a file is geocentric, with the way to a projected system; `option` needs the plan. Its
// system says so. Without a system and a unit, its first position says so: the distance from 0 0 0 is a
// radius of the Earth in metres.
void require_plan(const ScanFiles& scan, const std::string& option);

}  // namespace lacuna::io
