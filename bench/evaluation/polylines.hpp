// SPDX-License-Identifier: Apache-2.0
// Loops of other programs, as lines of a PLY file.
#pragma once

#include "io/loops/loops_reader.hpp"

#include <filesystem>
#include <vector>

namespace lacuna::evaluation {

// Whether a PLY file has lines and no ids of points, so that its loops are made of vertices of their own.
// Throws `Error` where it has neither, or is no PLY file.
bool has_polylines(const std::filesystem::path& file);

// The closed curves that element 'edge' makes of the vertices, by its integers 'vertex1' and 'vertex2'. Ids
// are places among the vertices. Loops are in the order of their first vertices; vertices without an edge are
// in none. Throws `Error` where a vertex has one edge, or more than two, and where one of them does not
// exist.
std::vector<io::LoopIds> read_polylines(const std::filesystem::path& file);

}  // namespace lacuna::evaluation
