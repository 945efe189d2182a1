// SPDX-License-Identifier: Apache-2.0
// loops.obj: the loops as polylines of Wavefront OBJ, for CAD, Blender and Rhinoceros.
#pragma once

#include "engine/model/detection.hpp"
#include "io/files/output_file.hpp"
#include "io/stations/cause.hpp"

namespace lacuna::io {

// Writes for each loop, in order: its measures as comments, its object "hole_0" or "outer_0" (the id), and
// its points. A line `l a b` for each edge follows. Blender 3.4 and MeshLab 2020.09 read only the first edge
// of a longer line. Coordinates have all digits. Holds one loop in memory. Throws `Error`.
void write_loops_obj(const ExplainedDetection& detection, OutputFile& out);

}  // namespace lacuna::io
