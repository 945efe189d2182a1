// SPDX-License-Identifier: Apache-2.0
// loops.dxf: the loops as closed 3D polylines of AutoCAD's DXF, in ASCII, release 12, which every reader
// takes.
#pragma once

#include "io/results/output_file.hpp"
#include "io/stations/cause.hpp"

#include <string_view>

namespace lacuna::io {

// How it begins: an earlier one is recognised by it.
inline constexpr std::string_view kDxfMark = "999\nlacuna detect, loops\n";

// One entity POLYLINE for each loop, in order, on the layer "holes" or "outer_curves": release 12 has no
// blanks in names. The id, the kind and the measures are its extended data of the application LACUNA: a name,
// then its value. Coordinates have all digits. Holds one loop in memory. Throws `Error`.
void write_loops_dxf(const ExplainedDetection& detection, OutputFile& out);

}  // namespace lacuna::io
