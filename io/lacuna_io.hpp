// SPDX-License-Identifier: Apache-2.0
// Files of scans and results, as a library: `#include <lacuna/lacuna_io.hpp>`, target lacuna::io.
//
// - Scans: `io::ScanFiles` opens files, and `io::ScanPass` (io/read/scan/) is a `PointSource` that reads
// them, for
//   `find_holes` and `detect`.
//   `io::open_scan` (io/read/formats.hpp) reads rows of one file with all columns.
// - Parameters: `io::FilesConfig` (io/read/options/options.hpp) has the parameters of the engine and of
// files.
// - Results: `io::write_results` (io/write/results/results.hpp) writes what `lacuna detect` writes.
// - Areas: `io::check_scan` (io/explain/area/check_area.hpp) finds what a scan does not cover, and
//   `io::write_voids` (io/write/results/results.hpp) writes it, as `lacuna check` does.
// - The report: `io::write_report` (io/write/report/report.hpp) makes it from results in a folder.
#pragma once

#include "io/explain/area/check_area.hpp"
#include "io/read/formats.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "io/write/report/report.hpp"
#include "io/write/results/results.hpp"
