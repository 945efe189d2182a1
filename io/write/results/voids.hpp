// SPDX-License-Identifier: Apache-2.0
// The voids of an area as files: voids.json, voids.csv and voids.gpkg. docs/area.md describes them.
#pragma once

#include "engine/export.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/read/files/result_folder.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

#include <filesystem>
#include <vector>

namespace lacuna::io {

// Writes voids.json, voids.csv and voids.gpkg to the folder. The first has the sums, the voids with their
// outlines, and the table; what is not finite is null. The second has a line for each void; what is not
// finite is empty. Memory: one void. Throws `Error`.
void add_voids(const AreaCheck& check, const ScanFiles& scan, const AreaConfig& config,
               const ResultFolder& folder);

// Writes these files alone to the folder, and the sheet of the check (io/write/report/report.hpp) where
// the config wants a report, which then takes its name. Returns the files. Throws `Error`.
LACUNA_API std::vector<std::filesystem::path> write_voids(const AreaCheck& check, const ScanFiles& scan,
                                                          const FilesConfig& config, ResultFolder& folder);

}  // namespace lacuna::io
