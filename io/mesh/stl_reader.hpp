// SPDX-License-Identifier: Apache-2.0
// STL, triangles without shared vertices: ASCII and binary.
#pragma once

#include "io/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

// Whether a file is binary: its size fits the number of triangles, whatever the header says. Some begin with
// "solid", too.
bool looks_like_stl(const FileStart& start);

// Rows are the vertices of the triangles, three each, in file order. They have x y z, as floats of a binary
// file and doubles of an ASCII one. A vertex of six triangles is six equal points. Normals belong to
// triangles, and are left out. An ASCII file may hold several solids, each with its end; a file without such
// an end is an `Error`.
std::unique_ptr<ScanReader> open_stl(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
