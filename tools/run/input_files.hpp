// SPDX-License-Identifier: Apache-2.0
// The scan files that the user names, one by one, by folder or in a list.
#pragma once

#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

#include <filesystem>
#include <vector>

namespace lacuna::tools {

// A folder stands for the scan files in it, sorted by name, and with `recursive` for the scan files in its
// folders. Hidden files are passed over. One warning names other files and folders that are not read. Text
// among scans of other formats is one of these. With `skip_damaged`, files that cannot be read to their end
// are left out with a warning. A folder with an ept.json, or that file, stands for the LAZ files in its
// ept-data. They have as many points as it counts (io/read/ept.hpp); with `skip_damaged`, a warning says where
// they have not. "@FILE" stands for the files named in it, one per line, relative to its folder; blank
// lines and lines that begin with # are passed over. A pose may follow the name: `pose=` and its numbers, or
// a file that holds them (io/read/rows/pose.hpp), or `viewpoint`, the one of the scan file. Throws `Error` if
// a folder or list names no scan, if a pose is not valid, and for "-".
std::vector<io::ScanInput> expand_inputs(const std::vector<std::filesystem::path>& given,
                                         const io::FilesConfig& config = {});

// Returns the options by which a run with this config reads its files.
io::ReadOptions read_options(const io::FilesConfig& config);

}  // namespace lacuna::tools
