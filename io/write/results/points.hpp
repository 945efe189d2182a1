// SPDX-License-Identifier: Apache-2.0
// The annotated scan: every row of the input in order, all of its columns, then the results.
//
// With points_format `input`, each file of the scan has one of the same name in the folder `points`. LAS, LAZ
// and PLY stay what they are, and text becomes CSV. LAS and LAZ files keep their header, records, scale and
// extra bytes. Files of other formats become PLY. So does LAS with a pose, since its scale may not hold the
// moved coordinates. The ending of each name follows the format.
//
// Else all files are joined to one, points.ply or points.csv, by the names of columns.
//
// A column of the input with the name of a result is left out, as an earlier run wrote it. PLY and CSV name
// results scalar_probability, scalar_angle and so on, as CloudCompare shows them. In PLY, `quality` is the
// probability for MeshLab, unless the input has a `quality`. Each file is read once more.
#pragma once

#include "engine/model/detection.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/files/result_folder.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

namespace lacuna::io {

// Throws `Error` if the annotated scan of the config cannot be written, as far as headers and names show it.
// Two files of the scan may have the same name, or a format may not hold its results. Cheap, for a program to
// check before the work.
void check_points(const ScanFiles& scan, const FilesConfig& config);

// Writes the annotated scan, if the config wants it. Memory: a batch of one file at a time. Throws `Error`.
void write_points(const ExplainedDetection& detection, const ScanFiles& scan, const FilesConfig& config,
                  const ResultFolder& folder);

}  // namespace lacuna::io
