// SPDX-License-Identifier: Apache-2.0
// Reads loops of other programs, as lines of a PLY file.
#pragma once

#include "bench/evaluation/loops_reader.hpp"

#include <filesystem>
#include <vector>

namespace lacuna::evaluation {

// Whether a PLY file has lines and no ids of points, so that its loops have vertices of their own. Throws
// `Error` if it has neither, or is no PLY file.
bool has_polylines(const std::filesystem::path& file);

// Returns the closed curves that element 'edge' makes of the vertices, by its integers 'vertex1' and
// 'vertex2'. Ids are places among the vertices. Loops are in the order of their first vertices; vertices
// without an edge are in no loop. Throws `Error` if a vertex has one edge, or more than two, or does not
// exist.
std::vector<LoopIds> read_polylines(const std::filesystem::path& file);

}  // namespace lacuna::evaluation
