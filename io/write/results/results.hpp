// SPDX-License-Identifier: Apache-2.0
// What a run leaves in its output folder. Ids are ranks of the input's rows, over the files in order.
#pragma once

#include "engine/export.hpp"
#include "engine/model/detection.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/scan/scan_files.hpp"

#include <filesystem>
#include <limits>
#include <vector>

namespace lacuna::io {

// Returns the middle of the bounds of the scan without its strays, in whole units; 0 0 0 without points. It
// depends on the scan alone. Without --local-coordinates there is no offset. With it, floats keep 2^-24 of
// the extent around the offset.
LocalOffset local_offset(const Detection& detection, const OutputConfig& config);

// Returns the type of the coordinates of vertices.
Scalar coordinate_type(const ScanFiles& scan, const OutputConfig& config);

// Returns the columns of the scan's files as a run writes them: with --local-coordinates, x y z are floats.
std::vector<RowLayout> written_layouts(const ScanFiles& scan, const OutputConfig& config);

struct LidMeasures {
  std::uint64_t vertices = 0, triangles = 0;
  double area = std::numeric_limits<double>::quiet_NaN();  // without a lid
};

// Returns the measures of each loop's lid, by its id. Outer curves have no lid. One warning counts the holes
// without one, and has the reason of the first. The threads make several lids at once: kLidBytes for each,
// within a quarter of the memory limit if one fits. Throws `Error`.
std::vector<LidMeasures> measure_lids(const Detection& detection);

// lids.ply: element vertex with x y z in the coordinates of loops.ply, and scalar_loop, the id of the hole.
// Element face has list vertex_indices alone, since meshio 5 reads no faces with more. Lids are made once
// more, as they may be larger than memory, and the file has all vertices first. Throws `Error`.
void write_lids(const std::vector<LidMeasures>& lids, const Detection& detection, const ScanFiles& scan,
                const OutputConfig& config, OutputFile& out);

// Throws `Error` if an input is an earlier result that the folder replaces. Throws, too, if the annotated
// scan cannot be written in its format. write_results checks it, too; a program checks before the work.
LACUNA_API void check_results(const ScanFiles& scan, const FilesConfig& config, const ResultFolder& folder);

// Writes loops.ply, boundary.ply, sample.ply, holes.csv, run.json, holes.json, and the files that the config
// requests. The report is made of the others. The folder takes its name when all are complete. Returns the
// files and subfolders that were written. Throws `Error`.
LACUNA_API std::vector<std::filesystem::path> write_results(const ExplainedDetection& detection,
                                                            const ScanFiles& scan, const FilesConfig& config,
                                                            ResultFolder& folder);
// Does the same with a folder of this name.
LACUNA_API std::vector<std::filesystem::path> write_results(const ExplainedDetection& detection,
                                                            const ScanFiles& scan, const FilesConfig& config,
                                                            const std::filesystem::path& folder);

// holes.json: the parameters that change results, the inputs, counts, and one line for each loop, in order.
// Runs with the same answer write the same bytes. docs/holes.schema.json describes it; the form has a number,
// kHolesSchema. What is not finite is null.
void write_holes(const ExplainedDetection& detection, const ScanFiles& scan, const FilesConfig& config,
                 OutputFile& out);

// run.json: what may differ between runs with the same answer: threads, tiles, times, memory. It has the
// coordinate reference system and the unit, too. What depends on the answer belongs in holes.json.
void write_run(const Detection& detection, const ScanFiles& scan, const FilesConfig& config, OutputFile& out);

// holes.csv: one line for each loop, the largest first, with the ids of holes.json and kTableMeasures. What
// is not finite is empty. With lids, there is a column lid_area.
void write_table(const ExplainedDetection& detection, const std::vector<LidMeasures>& lids, OutputFile& out);

// Names as CloudCompare ("scalar_", of which it shows the first one) and MeshLab (quality: the probability)
// have them. Element vertex: x y z, scalar_loop (an index into the report's loops), scalar_id, scalar_outer
// (0: hole, 1: outer), quality, red green blue (io/write/loops/loop_colours.hpp). Element edge: vertex1
// vertex2, closing each loop. Coordinates here and below: see `local_offset`.
void write_loops(const Detection& detection, const ScanFiles& scan, const OutputConfig& config,
                 OutputFile& out);

// Every point that is coherent or on a loop, in ascending id: x y z, scalar_probability, scalar_id,
// scalar_loop (-1: none), quality (the probability).
void write_boundary(const Detection& detection, const ScanFiles& scan, const OutputConfig& config,
                    OutputFile& out);

// The points of the sample, in ascending id: x y z, scalar_id, nx ny nz, scalar_probability, and the colours
// of the input. These are red green blue and intensity, as far as a file has them. Reads every file once more
// for these; compressed ones only where a report is wanted.
void write_sample(const Detection& detection, const ScanFiles& scan, const OutputConfig& config,
                  OutputFile& out);

// For the writers: x, y and z of their type, and the id. PLY has no integer of 64 bits: ids
// are uint, or, from 2^32 points on, double, which is exact up to 2^53.
std::vector<PlyProperty> position_and_id(const Detection& detection, const ScanFiles& scan,
                                         const OutputConfig& config);

// Writes voids.json, voids.csv and voids.gpkg, which docs/area.md describes, to the folder, which then takes
// its name. The first has the sums, the voids with their outlines, and the table; what is not finite is null.
// The second has a line for each void; what is not finite is empty. Where the config wants a report, the
// sheet of the check (io/write/report/report.hpp) is there, too. Returns the files. Memory: one void. Throws
// `Error`.
LACUNA_API std::vector<std::filesystem::path> write_voids(const AreaCheck& check, const ScanFiles& scan,
                                                          const FilesConfig& config, ResultFolder& folder);

// The annotated scan (points.cpp).

// Throws `Error` if the annotated scan of the config cannot be written, as far as headers and names show it.
// Two files of the scan may have the same name, or a format may not hold its results. Cheap, for a program to
// check before the work.
void check_points(const ScanFiles& scan, const FilesConfig& config);

// Writes the annotated scan, if the config wants it. Memory: a batch of one file at a time. Throws `Error`.
void write_points(const ExplainedDetection& detection, const ScanFiles& scan, const FilesConfig& config,
                  const ResultFolder& folder);

}  // namespace lacuna::io
