// SPDX-License-Identifier: Apache-2.0
// Facts about a coordinate reference system from its well-known text (OGC 01-009; ISO 19162).
#pragma once

#include <string_view>

namespace lacuna::io {

// Returns the part that positions are in, such as `PROJCS[...]` of a compound system. Returns an empty text
// if the text is a code, or has no such part.
std::string_view horizontal_system(std::string_view crs);

// Whether positions are longitude and latitude. False where the text is a code.
bool is_geographic(std::string_view crs);

}  // namespace lacuna::io
