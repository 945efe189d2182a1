// SPDX-License-Identifier: Apache-2.0
// OFF, the text format of Geomview: the vertices of a mesh.
#pragma once

#include "io/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_off(const FileStart& start);

// Reads OFF, COFF (colours), NOFF (normals) and CNOFF or NCOFF. The first line or the next has the numbers of
// vertices, faces and, if it is there, edges. # begins a comment. Columns are x y z, then nx ny nz, as
// doubles. Then come red green blue or red green blue alpha, as many as the first vertex has, as floats.
// Colours are bytes in some files, 0 to 1 in others, and stay as they are. One vertex or face is on a line.
// Faces are passed over, but must be complete, and nothing may follow the last one. Other kinds (texture
// coordinates, four dimensions) and the binary encoding are an `Error` that names them.
std::unique_ptr<ScanReader> open_off(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
