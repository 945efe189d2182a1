// SPDX-License-Identifier: Apache-2.0
// Disk space and time of a run, from its points and its options alone.
#pragma once

#include "engine/config/config.hpp"
#include "io/scan/file_scan.hpp"

#include <cstdint>

namespace lacuna::tools {

struct RunCosts {
  std::uint64_t least_disk = 0;  // that an even scan takes, which has few curves
  std::uint64_t disk = 0;        // bytes of temporary files, at the peak
  double seconds = 0;            // on a machine that does nothing else
};

// `rows` are the input's. `points` take part; they are fewer than the rows if a scan is thinned or filtered.
// Each cost is a number of points times the rates of the table in run_costs.cpp.
RunCosts run_costs(const io::FileScan& scan, const Config& config, std::uint64_t rows, std::uint64_t points);

}  // namespace lacuna::tools
