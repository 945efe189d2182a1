// SPDX-License-Identifier: Apache-2.0
// The faces of a PLY file, for meshes whose boundary is known.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace lacuna::evaluation {

// Corners are rows of element "vertex".
using Triangle = std::array<std::uint64_t, 3>;

// Reads the polygons of list "vertex_indices" (or "vertex_index") of element "face", in file order. Each
// becomes a fan around its first corner; a polygon of fewer than three corners gives no triangle. Throws
// `Error` if the file is not a complete PLY, has no such list, or a face names a vertex that does not exist.
std::vector<Triangle> read_triangles(const std::filesystem::path& file);

}  // namespace lacuna::evaluation
