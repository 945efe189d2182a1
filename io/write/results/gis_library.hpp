// SPDX-License-Identifier: Apache-2.0
// The results that lacuna_gis.so writes.
#pragma once

#include "engine/model/detection.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/write/results/loops_gis.hpp"

namespace lacuna::io {

inline constexpr const char* kGisUser = "--gpkg, --geojson, --coverage and --area";  // for errors

// Loads the library on first use and writes the loops. The log has a warning if the scan has a coordinate
// reference system and the file has none. Another warning comes if GIS will read metres as degrees. Throws
// `Error`.
void write_loops_gis(const ExplainedDetection& detection, const ScanFiles& scan, const OutputConfig& config,
                     GisFormat format, OutputFile& out);

// Writes coverage.tif in the same way (io/write/results/coverage_tif.hpp); writes no file if no point takes part.
void write_coverage(const Detection& detection, const ScanFiles& scan, const FilesConfig& config,
                    OutputFile& out);

// Writes voids.gpkg in the same way (io/write/results/voids_gis.hpp).
void write_voids_gpkg(const AreaCheck& check, const ScanFiles& scan, OutputFile& out);

}  // namespace lacuna::io
