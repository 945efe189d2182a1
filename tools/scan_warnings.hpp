// What is odd about a scan: not wrong, but hardly meant.
#pragma once

#include "engine/config.hpp"
#include "engine/model/detection.hpp"
#include "io/file_scan.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

// One line for each file that is given more than once, also by another name.
std::vector<std::string> repeated_files(const std::vector<std::filesystem::path>& scans);

// After a run: too few points for their neighbourhoods, and coordinates that are too coarse for their
// spacing.
std::vector<std::string> scan_warnings(const FileScan& scan, const Summary& summary, const Config& config);

}  // namespace lacuna
