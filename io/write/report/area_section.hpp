// SPDX-License-Identifier: Apache-2.0
// The check of an area, for the report.
#pragma once

#include "io/write/loops/json.hpp"

#include <filesystem>

namespace lacuna::io {

// Returns voids.json of a folder with the largest voids and the first polygons alone, and with outlines as
// fine as a map shows them. Returns null if the file is not there. Throws `Error` if it is not as Lacuna
// writes it.
Json read_area_section(const std::filesystem::path& folder);

}  // namespace lacuna::io
