// SPDX-License-Identifier: Apache-2.0
// Recognises files for GIS that an earlier run wrote. These formats have no comments at their start.
#pragma once

#include "io/files/output_set.hpp"

#include <string_view>

namespace lacuna::io {

inline constexpr std::string_view kGeoJsonMark =
    "{\n\"type\": \"FeatureCollection\",\n\"name\": \"lacuna_loops\",\n";

// The file is an SQLite file that names the layer and its description in its first pages.
FileMark geopackage_mark();

// The file names the layer and the description of voids.gpkg likewise.
FileMark voids_gpkg_mark();

// The file is a TIFF that names the software of coverage.tif.
FileMark coverage_mark();

}  // namespace lacuna::io
