// SPDX-License-Identifier: Apache-2.0
// report.html: the scan and its holes in 3D, in one file for a browser, without a network.
#pragma once

#include "engine/export.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/write/loops/json.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna::io {

// The page of io/write/report/page with its style, its scripts and three.js in it, put together by the build.
extern const std::string_view kReportPage;
// The rules of a sheet, page/sheet.css. The page of a run has more rules for paper than for the screen; the
// sheet looks alike on both.
extern const std::string_view kSheetStyle;
inline constexpr std::string_view kDataPlace = "<!--{data}-->\n";  // where a report's data go

struct Scene;

// A report.html begins with this text, by which a program recognises an earlier one.
inline constexpr std::string_view kReportMark = "<!doctype html>\n<!-- Lacuna report";

// Writes report.html into the folder of a run's results, from these results. Replaces an earlier report.
// Returns the name of the file. Throws `Error`.
LACUNA_API std::filesystem::path write_report(const std::filesystem::path& folder, Overwrite overwrite);

// Writes the page of a scene to a file in a folder of results, which then counts it among them. Throws
// `Error`.
void write_report(const Scene& scene, const std::filesystem::path& file, Overwrite overwrite);

// Writes the page with a scene as its data. Positions are 21 bits along each axis, of the cube of the scene.
// A point takes about 15 bytes, a vertex of a loop 11.
void write_report(const Scene& scene, OutputFile& out);

// The check of an area on pages: a part of the report of a run, and report.html of a check. That is one sheet
// by which a survey is accepted or not, for a browser and for paper.

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
