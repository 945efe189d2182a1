// SPDX-License-Identifier: Apache-2.0
// The voids of an area as files: voids.json, voids.csv and voids.gpkg. docs/area.md describes them.
#pragma once

#include "engine/export.hpp"
#include "io/area/area_check.hpp"
#include "io/area/voids_form.hpp"
#include "io/files/output_set.hpp"
#include "io/options/options.hpp"
#include "io/scan/file_scan.hpp"

#include <filesystem>
#include <string_view>
#include <vector>

namespace lacuna::io {

inline constexpr std::string_view kVoidsHeader =
    "id,kind,counts,area,circle,x,y,spacing,excepted";  // of voids.csv

// The sums, the voids with their outlines, and the table. Memory: one void. What is not finite is null.
void write_voids_json(const AreaCheck& check, const FileScan& scan, const AreaConfig& config,
                      OutputFile& out);

// One line for each void. What is not finite is empty.
void write_voids_table(const AreaCheck& check, OutputFile& out);

// Throws `Error` if the results of `lacuna check` may not be written to `folder`.
LACUNA_API void check_voids_folder(const FileScan& scan, const std::filesystem::path& folder,
                                   Overwrite overwrite);

// Writes these files alone, as one set. Makes the folder if it is missing. Returns the files. Throws `Error`.
LACUNA_API std::vector<std::filesystem::path> write_voids(const AreaCheck& check, const FileScan& scan,
                                                          const AreaConfig& config,
                                                          const std::filesystem::path& folder,
                                                          Overwrite overwrite);

}  // namespace lacuna::io
