// SPDX-License-Identifier: Apache-2.0
// report.html: the scan and its holes in 3D, in one file for a browser, without a network.
#pragma once

#include "io/report/marks.hpp"
#include "io/report/scene.hpp"
#include "io/results/output_set.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace lacuna::io {

// How a report.html begins: an earlier one is recognised by it.
inline constexpr std::string_view kReportMark = "<!doctype html>\n<!-- Lacuna report";

// Writes the page of io/report/page with the scene as data. Positions are 21 bits along each axis, of the
// cube of the scene. About 15 bytes for each point, 11 for each vertex of a loop. The page starts with the
// marks; `matches` are those with the scene's loops.
void write_report(const Scene& scene, OutputFile& out, const MatchedMarks& marks = {});

struct WrittenReport {
  std::filesystem::path file;
  MatchedMarks marks;  // those that it starts with
};

// report.html in the folder of a run's results, from these. Replaces an earlier report. `marks`: a file of
// marks that the page starts with. Throws `Error`.
WrittenReport write_report(const std::filesystem::path& folder, Overwrite overwrite,
                           const std::optional<std::filesystem::path>& marks = {});

}  // namespace lacuna::io
