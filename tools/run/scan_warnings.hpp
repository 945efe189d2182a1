// SPDX-License-Identifier: Apache-2.0
// What is odd about a scan: not wrong, but hardly meant.
#pragma once

#include "engine/model/detection.hpp"
#include "io/scan/file_scan.hpp"
#include "io/stations/cause.hpp"

#include <string>
#include <vector>

namespace lacuna::tools {

// The name within well-known text, such as "NAD83 / UTM zone 10N"; a code stays as it is.
std::string crs_name(const std::string& crs);

// Throws `Error` where positions are longitude and latitude: nothing of a run fits degrees.
void refuse_degrees(const io::FileScan& scan);

// Before a run: one line for each file that is given more than once, also by another name. One, too, for each
// whose coordinate reference system differs from the first. One line for all files without a system where
// others have one. One line for files with another unit, and one for files that contradict --crs or --unit.
std::vector<std::string> input_warnings(const io::FileScan& scan);

// Before a run: a memory limit above the machine's memory.
std::vector<std::string> memory_warnings(const Config& config);

// A box of the scan as people and --bounds have it: six numbers with three digits of its extent. They are
// rounded outwards by at most one step of the last digit. `margin` is added on all sides.
std::string print_bounds(const Eigen::AlignedBox3d& box, double margin);

// How many points lie far from all others, where, and which option leaves them out; empty without any.
std::string stray_warning(const Strays& strays, double resolution);

// Stations that do not count, as their points cannot all have been seen from there.
std::vector<std::string> station_warnings(const std::vector<io::StationSummary>& stations);

// After a run: strays, too few points for their neighbourhoods, coordinates too coarse for their spacing, and
// rows that LAS or LAZ cannot hold.
std::vector<std::string> scan_warnings(const io::FileScan& scan, const Summary& summary,
                                       const io::FilesConfig& config);

}  // namespace lacuna::tools
