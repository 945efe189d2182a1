// What a run leaves in its output folder. Ids are ranks of the input's rows, over the files in order.
#pragma once

#include "engine/config.hpp"
#include "engine/data/detection.hpp"
#include "io/file_scan.hpp"
#include "io/output_file.hpp"
#include "io/ply_header.hpp"

#include <filesystem>

namespace lacuna {

// Writes holes.json, loops.ply, boundary.ply and, when asked for, points.ply. They appear together, when all
// are complete, in place of those of an earlier run; holes.json last. Makes the folder if it is missing.
// Throws `Error`.
void write_results(const Detection& detection, const FileScan& scan, const Config& config,
                   const std::filesystem::path& folder);

// Throws `Error` if results in `folder` would take the place of a file of the input. write_results asks, too;
// a program asks before the work.
void check_output_folder(const FileScan& scan, const std::filesystem::path& folder);

// The report: parameters, counts, times, and one line for each loop, in order. A loop's line depends on the
// loop alone. What is not finite is null.
void write_report(const Detection& detection, const FileScan& scan, const Config& config, OutputFile& out);

// Element vertex: x y z, id, loop (an index into the report's loops). Element edge: vertex1 vertex2, closing
// each loop.
void write_loops(const Detection& detection, const FileScan& scan, OutputFile& out);

// Every point that is coherent or on a loop, in ascending id: x y z, id, scalar_probability, scalar_loop (-1:
// none).
void write_boundary(const Detection& detection, const FileScan& scan, OutputFile& out);

// All rows of the input, in order: its scalar properties as they came, then the results. Files are
// joined by property name: in double where types differ, NaN or 0 in the rows of a file that has none. A
// property of the input with the name of a result is left out. Reads every file once more.
void write_points(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                  OutputFile& out);

// Bytes of a row of points.ply.
std::uint64_t point_row_bytes(const FileScan& scan, const OutputConfig& config);

// For the writers: x, y and z in the scan's precision, and the id. PLY has no integer of 64 bits: ids
// are uint, or, from 2^32 points on, double, which is exact up to 2^53.
std::vector<PlyProperty> position_and_id(const Detection& detection, const FileScan& scan);

}  // namespace lacuna
