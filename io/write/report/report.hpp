// SPDX-License-Identifier: Apache-2.0
// report.html: the scan and its holes in 3D, in one file for a browser, without a network.
#pragma once

#include "engine/export.hpp"
#include "io/read/files/output_file.hpp"

#include <filesystem>
#include <string_view>

namespace lacuna::io {

// The page of io/write/report/page with its style, its scripts and three.js in it, put together by the build.
extern const std::string_view kReportPage;
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

}  // namespace lacuna::io
