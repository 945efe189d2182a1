// SPDX-License-Identifier: Apache-2.0
// loops.vtp: the loops as poly data of VTK's XML, for ParaView and VTK.
#pragma once

#include "io/results/output_file.hpp"
#include "io/stations/cause.hpp"

#include <string_view>

namespace lacuna::io {

// How it begins: an earlier one is recognised by it.
inline constexpr std::string_view kVtpMark = "<?xml version=\"1.0\"?>\n<!-- lacuna detect, loops -->\n";

// One closed line for each loop, in order. Data of lines: id, kind (0 hole, 1 outer), each measure. Data of
// points: id, probability. Coordinates and measures are doubles, in binary. Reads each loop three times, and
// holds one in memory. Throws `Error`.
void write_loops_vtp(const ExplainedDetection& detection, OutputFile& out);

}  // namespace lacuna::io
