// SPDX-License-Identifier: Apache-2.0
// The cut-outs of a run: for each hole, the points of the scan around it as a file of their own.
#pragma once

#include "engine/model/detection.hpp"
#include "io/files/output_set.hpp"
#include "io/options/options.hpp"
#include "io/scan/file_scan.hpp"

#include <cstddef>
#include <filesystem>

namespace lacuna::io {

inline constexpr const char* kCutOutsFolder = "cut-outs";  // in the output folder
// A CSV file has no place for a mark but its columns. So its last column is the id of the hole.
inline constexpr const char* kCutOutColumn = "lacuna_hole";

// Throws `Error` if the cut-outs of the config cannot be written to `folder`, as far as headers and names
// show it. Cheap, for a program to check before the work.
void check_cut_outs(const FileScan& scan, const FilesConfig& config, const std::filesystem::path& folder,
                    Overwrite overwrite);

// Adds `cut-outs/hole-12.ply` and so on to the set, one for each hole, by its index among the loops. Drops
// the cut-outs of earlier runs. Without config.output.cut_outs it only drops them.
//
// A cut-out has the rows of the scan in the bounds of the loop, widened by config.output.cut_outs on all
// sides. The rows are in the order of the input. Filters leave no row out. All columns of the input stay,
// also columns of earlier results. The format is joined_format() (io/results/points.hpp).
//
// Reads every file once for each `most_holes` holes, or for as many as fit in memory. Their rows go to one
// temporary file first, since PLY begins with the number of rows. So two files are open at a time, besides
// the scan. Memory: 400 bytes a hole, and an eighth of the memory limit in each pass. Cost: linear in the
// points of the scan and in the points written. The bytes do not depend on the passes. Throws `Error`.
void write_cut_outs(const Detection& detection, const FileScan& scan, const FilesConfig& config,
                    const std::filesystem::path& folder, OutputSet& set,
                    std::size_t most_holes = std::size_t{1} << 14);

}  // namespace lacuna::io
