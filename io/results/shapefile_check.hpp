// SPDX-License-Identifier: Apache-2.0
// Whether all of a Shapefile is on the disk: GDAL's last writes, as it closes the files, may fail without an
// error.
#pragma once

#include <filesystem>

namespace lacuna::io {

// Returns the first of the files that belong to `shp` that is missing or shorter than its head says; empty:
// none. The .prj only `with_crs`.
std::filesystem::path find_cut_part(const std::filesystem::path& shp, bool with_crs);

}  // namespace lacuna::io
