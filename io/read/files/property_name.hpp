// SPDX-License-Identifier: Apache-2.0
// The names of properties, the same whatever the format they come from.
#pragma once

#include <string>
#include <string_view>

namespace lacuna::io {

// Returns the text with A to Z in lower case.
std::string lower_case(std::string_view text);

// Returns the names of position and normal for X Y Z and NX NY NZ, in any mix of cases, and others as they
// are.
std::string known_name(std::string_view given);

// Returns the name as it can be written in a PLY header: blanks and control characters become '_'.
std::string property_name(std::string_view given);

// The names of the properties that make the colour of a point.
inline constexpr const char* kColourNames[] = {"red", "green", "blue", "intensity"};

// Returns one spelling for "return_number", PDAL's "ReturnNumber" and CloudCompare's "scalar_Return_Number":
// without case, blanks and underscores.
std::string bare_name(std::string_view name);

}  // namespace lacuna::io
