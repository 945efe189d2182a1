// SPDX-License-Identifier: Apache-2.0
// The annotated scan, points.ply, .las, .laz, .pcd or .csv: every row of the input in order, all of its
// columns, then the results. Files are joined by the names of columns. A column of the input with the name of
// a result is left out, as an earlier run wrote it. Each writer reads every file once more. All throw
// `Error`.
#pragma once

#include "engine/model/detection.hpp"
#include "io/file_scan.hpp"
#include "io/options/options.hpp"
#include "io/results/output_set.hpp"

#include <cstdint>
#include <string>

namespace lacuna::io {

// As config.points_format says. With `input`, it is the format of the files, if all have the same and it can
// be written. That holds for PLY, LAS, LAZ, PCD, and CSV for text. LAS and LAZ files together are LAS. Else
// it is PLY. Never kInput.
PointsFormat points_format(const FileScan& scan, const OutputConfig& config);
std::string extension_of(PointsFormat format);                              // ".ply" and so on
std::string points_file(const FileScan& scan, const OutputConfig& config);  // "points.ply" and so on

// Throws `Error` where that format cannot hold the scan, as far as headers show it. Cheap: for before the
// work.
void check_points(const FileScan& scan, const OutputConfig& config);

// Bytes of a row. A guess for CSV and LAZ, and for LAS from other formats.
std::uint64_t point_row_bytes(const FileScan& scan, const OutputConfig& config);

// PLY, binary little endian. Properties have the names of the input. Results are scalar_probability,
// scalar_angle and so on, as CloudCompare shows them. `quality` is the probability for MeshLab, unless the
// input has a `quality`.
void write_points_ply(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out);

// LAS 1.4 (io/las/las_join.hpp has how files are joined, io/las/las_import.hpp how other formats become LAS).
// Results are extra bytes: probability, angle and so on. Rows of other formats without a finite position are
// left out.
void write_points_las(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out);
// As write_points_las(), and compressed: point formats 0 to 3 and 6 to 8.
void write_points_laz(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out);
FileMark points_las_mark();  // of both

// PCD, binary. From PCD files with the same fields and without poses, all fields as they are; a single one
// keeps WIDTH, HEIGHT and VIEWPOINT. Else red green blue as bytes become `rgb`, with alpha `rgba`, and nx ny
// nz normal_x normal_y normal_z.
void write_points_pcd(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out);

// A header line and a line for each row, divided by commas. Each number is the shortest text that reads back
// as the same value of its type; `nan` where there is none.
void write_points_csv(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out);
FileMark points_csv_mark();

// What each of them says of its rows.
std::uint64_t ply_row_bytes(const FileScan& scan, const OutputConfig& config);
std::uint64_t las_row_bytes(const FileScan& scan, const OutputConfig& config);
std::uint64_t laz_row_bytes(const FileScan& scan, const OutputConfig& config);
std::uint64_t pcd_row_bytes(const FileScan& scan, const OutputConfig& config);
std::uint64_t csv_row_bytes(const FileScan& scan, const OutputConfig& config);
void check_points_las(const FileScan& scan, const OutputConfig& config);
void check_points_laz(const FileScan& scan, const OutputConfig& config);
void check_points_pcd(const FileScan& scan, const OutputConfig& config);

}  // namespace lacuna::io
