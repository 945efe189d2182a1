// SPDX-License-Identifier: Apache-2.0
// Checks before a run whether the disks hold its files.
#pragma once

#include "engine/run/disk_space.hpp"
#include "io/options/options.hpp"
#include "io/scan/file_scan.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::tools {

using FindDisk = std::function<std::optional<Disk>(const std::filesystem::path& folder)>;

// Knows the headers of the scan and the options. Returns one line for each disk that is probably too small
// for the workspace, the results, or both. Throws `Error` for a disk that clearly is too small. Such a disk
// has less than half of the table's sum, or less than an annotated scan of known size. If a filter or a
// resolution may leave points out, only the annotated scan is certain. Throws `Error`, too, if memory can
// never suffice. Both folders exist.
std::vector<std::string> check_disks(const io::FileScan& scan, const io::FilesConfig& config,
                                     const std::filesystem::path& workspace, const std::filesystem::path& out,
                                     const FindDisk& find_disk = disk_of);

}  // namespace lacuna::tools
