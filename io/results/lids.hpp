// SPDX-License-Identifier: Apache-2.0
// The lids of holes, as meshes and as a table. io/lids/make_lid.hpp says what they are.
#pragma once

#include "engine/model/detection.hpp"
#include "io/files/output_file.hpp"
#include "io/options/options.hpp"
#include "io/scan/scan_files.hpp"

#include <filesystem>

namespace lacuna::io {

// lids.obj has for each hole, in order, its object "hole_12" (the id), vertices with all digits and
// triangles. Comments have the numbers of both and the area. A hole without a lid has one comment, with the
// reason. Outer curves have no lids. Islands in a hole stay open. The threads make several lids at once:
// kLidBytes for each, within a quarter of the memory limit if one fits. Throws `Error`.
void write_lids_obj(const Detection& detection, OutputFile& out);

// Both files come from the complete lids.obj, which the functions stream. They throw `Error`.
//
// lids.ply: element vertex with x y z in the coordinates of loops.ply, and scalar_loop, the id of the hole.
// Element face has list vertex_indices alone, since meshio 5 reads no faces with more.
void write_lids_ply(const std::filesystem::path& lids_obj, const Detection& detection, const ScanFiles& scan,
                    const OutputConfig& config, OutputFile& out);
// lids.csv: a line for each hole. lid_area is empty if the hole has no lid, and reason if it has one.
void write_lids_table(const std::filesystem::path& lids_obj, OutputFile& out);

}  // namespace lacuna::io
