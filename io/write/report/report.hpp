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

// The pages of a run and of the check of an area. The build puts them together from io/write/report/page,
// with their styles and scripts, and three.js in the first.
extern const std::string_view kReportPage, kSheetPage;
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

// Writes the sheet by which a survey is accepted or not, for a browser and for paper. It shows what
// voids.json of the folder says of the scan with this title. Memory: the map, of some thousand corners for
// each polygon.
void write_area_sheet(const std::filesystem::path& folder, const std::string& title, OutputFile& out);

}  // namespace lacuna::io
