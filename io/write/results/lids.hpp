// SPDX-License-Identifier: Apache-2.0
// The lids of holes. io/explain/lids/make_lid.hpp says what they are.
#pragma once

#include "engine/model/detection.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

#include <limits>
#include <vector>

namespace lacuna::io {

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

}  // namespace lacuna::io
