// SPDX-License-Identifier: Apache-2.0
// The check of an area on pages: a part of the report of a run, and report.html of a check. That is one sheet
// by which a survey is accepted or not, for a browser and for paper.
#pragma once

#include "io/explain/area/area_check.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/write/loops/json.hpp"

#include <filesystem>
#include <string>

namespace lacuna::io {

// Returns voids.json of a folder with the largest voids and the first polygons alone, and with outlines as
// fine as a map shows them. Returns null if the file is not there. Throws `Error` if it is not as Lacuna
// writes it.
Json read_area_section(const std::filesystem::path& folder);

// What a sheet says of the scan, besides its check.
struct AreaSheet {
  std::string title;      // the name of the scan
  std::string unit, crs;  // of the scan; empty: not known
};

// Writes the answer, the rule and its source, the basis, and what the check does not show. A map has density
// and voids, a table the largest voids. Fields for project, client and dates are filled in by the reader.
// It has the style of the report of a run. Memory: the map, of some thousand corners for each polygon.
void write_area_sheet(const AreaCheck& check, const AreaSheet& sheet, const AreaConfig& config,
                      OutputFile& out);

}  // namespace lacuna::io
