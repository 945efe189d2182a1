// SPDX-License-Identifier: Apache-2.0
// Between numpy and the engine: columns of scans, and results.
#pragma once

#include "engine/model/detection.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/scan/scan_files.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace lacuna::python {

// Columns by name, one-dimensional arrays of one length and of any stride, of a type that a PLY file has.
// They are not copied. Throws `Error`.
io::ScanArrays scan_of(const pybind11::dict& columns);

// The reported loops: one array for each measure; `offsets`, `ids` and `xyz` of their points, one loop after
// the other.
pybind11::dict loops_of(const io::ExplainedDetection& detection);

// One row for each point of the input: probability, criteria, boundary, coherent, loop, normal.
pybind11::dict points_of(const Detection& detection);
// Those of a block of points, and `first_id`.
pybind11::dict block_of(PointId first, std::span<const PointResult> block);

// The points of the sample: id, xyz, probability, normal.
pybind11::dict sample_of(const Detection& detection);

// Counts, bounds, levels, and the parameters in effect.
pybind11::dict summary_of(const io::ExplainedDetection& detection);

}  // namespace lacuna::python
