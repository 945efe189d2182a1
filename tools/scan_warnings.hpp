// What is odd about a scan: not wrong, but hardly meant.
#pragma once

#include "engine/config.hpp"
#include "engine/model/detection.hpp"
#include "io/file_scan.hpp"

#include <string>
#include <vector>

namespace lacuna::tools {

// The name within well-known text, such as "NAD83 / UTM zone 10N"; a code stays as it is.
std::string crs_name(const std::string& crs);

// Before a run: one line for each file that is given more than once, also by another name, and for each whose
// coordinate reference system is not that of the first.
std::vector<std::string> input_warnings(const io::FileScan& scan);

// Before a run: a memory limit above the machine's memory, and a disk with less free space than the run needs.
std::vector<std::string> machine_warnings(const io::FileScan& scan, const Config& config,
                                          const std::filesystem::path& workspace);

// After a run: too few points for their neighbourhoods, coordinates that are too coarse for their spacing, and
// rows that points.las cannot hold.
std::vector<std::string> scan_warnings(const io::FileScan& scan, const Summary& summary,
                                       const Config& config);

}  // namespace lacuna::tools
