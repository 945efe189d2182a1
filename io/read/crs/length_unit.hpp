// SPDX-License-Identifier: Apache-2.0
// The unit of length of a scan, where its file names one.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lacuna::io {

// Returns the unit that has this length in metres: "m", "km", "cm", "mm", "ft" (international foot), "us-ft"
// (US survey foot), "in", "yd". Empty for another length.
std::string unit_of_metres(double metres);
// Returns the length of such a unit in metres; empty for another name.
std::optional<double> metres_of_unit(std::string_view unit);

// Returns the horizontal unit of a coordinate reference system in well-known text (OGC 01-009; ISO 19162).
// Empty if the system is geographic, if the text is a code, or if it names another unit.
std::string length_unit(std::string_view crs);
// Returns the unit of its vertical system likewise; empty if it has none.
std::string vertical_unit(std::string_view crs);

}  // namespace lacuna::io
