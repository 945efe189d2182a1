// SPDX-License-Identifier: Apache-2.0
// Files of scans and results, as a library: `#include <lacuna/lacuna_io.hpp>`, target lacuna::io.
//
// - Scans: `io::ScanFiles` opens files, and `io::ScanPass` (io/scan/) is a `PointSource` that reads them, for
//   `find_holes` and `detect`.
//   `io::open_scan` (io/formats.hpp) reads rows of one file with all columns.
// - Parameters: `io::FilesConfig` (io/options/options.hpp) has the parameters of the engine and of files.
// - Results: `io::write_results` (io/results/results.hpp) writes what `lacuna detect` writes.
// - Areas: `io::read_area` and `io::check_area` (io/area/check_area.hpp) find what a scan does not cover, and
//   `io::write_voids` (io/results/voids.hpp) writes it, as `lacuna check` does.
// - The report: `io::write_report` (io/report/report.hpp) makes it from results in a folder.
#pragma once

#include "io/area/check_area.hpp"
#include "io/formats.hpp"
#include "io/options/options.hpp"
#include "io/report/report.hpp"
#include "io/results/results.hpp"
#include "io/results/voids.hpp"
#include "io/scan/scan_pass.hpp"
