// SPDX-License-Identifier: Apache-2.0
// Whether x and y of a scan are its plan, and where on Earth it lies.
#pragma once

#include "io/read/scan/scan_files.hpp"

#include <optional>
#include <string>

#include <Eigen/Core>

namespace lacuna::io {

// Returns a position of a file that is likely to be one of its surface; nothing if its first rows have none.
std::optional<Eigen::Vector3d> find_place(const ScanFiles& scan, std::size_t file);

// Returns the system in which the user can work instead, such as "EPSG:32632".
std::string utm_zone(double longitude, double latitude);

// Throws `Error` where a file is geocentric, with the way to a projected system; `option` needs the plan. Its
// system says so. Without a system and a unit, its first position says so: the distance from 0 0 0 is a
// radius of the Earth in metres.
void require_plan(const ScanFiles& scan, const std::string& option);

}  // namespace lacuna::io
