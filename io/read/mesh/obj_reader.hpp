// SPDX-License-Identifier: Apache-2.0
// OBJ, the text format of Wavefront: the vertices of a mesh.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_obj(const FileStart& start);

// Rows are vertices "v x y z", in file order, with x y z as doubles. The first vertex decides the values that
// every other has, too. A fourth value is a weight and left out; three more are red green blue, floats as
// they are in the file. Normals "vn" become nx ny nz if there are as many as vertices. Every face that names
// normals must also give each vertex the normal of the vertex's own number. Else the normals belong to faces
// or corners, and are left out. Lines of other kinds are skipped. A line that ends with a backslash goes on
// in the next one. Opening reads the whole file once, to count.
std::unique_ptr<ScanReader> open_obj(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
