// lacuna_gis.so, found and loaded where a result needs GDAL.
#pragma once

#include "engine/model/detection.hpp"
#include "io/file_scan.hpp"
#include "io/results/loops_gis.hpp"
#include "io/results/output_file.hpp"

namespace lacuna::io {

// Throws `Error` if the library is neither beside the program nor in ../lib/lacuna of its folder. Cheap:
// loads nothing.
void check_gis_library();

// Loads the library on first use and writes the loops. Where GDAL does not understand the crs that the files
// share, the log has one warning in a run. Throws `Error`.
void write_loops_gis(const Detection& detection, const FileScan& scan, GisFormat format, OutputFile& out);

}  // namespace lacuna::io
