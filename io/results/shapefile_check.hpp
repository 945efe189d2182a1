// Whether all of a Shapefile is on the disk: GDAL's last writes, as it closes the files, may fail without an
// error.
#pragma once

#include <filesystem>

namespace lacuna::io {

// Of the files that belong to `shp`, the first one that is shorter than its head says, or missing; empty:
// none. The .prj only `with_crs`.
std::filesystem::path find_cut_part(const std::filesystem::path& shp, bool with_crs);

}  // namespace lacuna::io
