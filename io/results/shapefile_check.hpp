// SPDX-License-Identifier: Apache-2.0
// Checks whether all of a Shapefile is on the disk. GDAL's last writes, as it closes the files, may fail
// without an error.
#pragma once

#include <filesystem>

namespace lacuna::io {

// Returns the first file of `shp` that is missing or shorter than its head says; empty if there is no such
// file. The .prj counts only `with_crs`.
std::filesystem::path find_cut_part(const std::filesystem::path& shp, bool with_crs);

}  // namespace lacuna::io
