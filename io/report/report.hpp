// SPDX-License-Identifier: Apache-2.0
// report.html: the scan and its holes in 3D, in one file for a browser, without a network.
#pragma once

#include "engine/export.hpp"
#include "io/files/output_set.hpp"
#include "io/report/marks.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace lacuna::io {

// How a report.html begins: an earlier one is recognised by it.
inline constexpr std::string_view kReportMark = "<!doctype html>\n<!-- Lacuna report";

struct WrittenReport {
  std::filesystem::path file;
  MatchedMarks marks;  // those that it starts with
};

// report.html in the folder of a run's results, from these. Replaces an earlier report. `marks`: a file of
// marks that the page starts with. Throws `Error`.
LACUNA_API WrittenReport write_report(const std::filesystem::path& folder, Overwrite overwrite,
                                      const std::optional<std::filesystem::path>& marks = {});

}  // namespace lacuna::io
