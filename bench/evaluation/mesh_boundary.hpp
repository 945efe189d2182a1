// SPDX-License-Identifier: Apache-2.0
// The true loops of a mesh.
#pragma once

#include "bench/evaluation/mesh_reader.hpp"
#include "io/explain/matching/match_loops.hpp"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {
using namespace matching;

// Every edge on exactly one triangle belongs to exactly one loop. Loops are simple. They come in the order of
// their vertices.
//
// A curve follows the directions in which the triangles pass their edges. At a vertex with several edges to
// go on, it crosses the gap in the mesh. It takes the first unused edge counterclockwise from the one on
// which it came. The view is against the mean normal of the triangles at these edges. Where the curve returns
// to a vertex, the part since then is a loop of its own.
//
// Where triangles disagree about their orientation, no edge may go on in the same direction; then any unused
// edge does. With edges on three triangles or more, curves may end. They begin and end at vertices with an
// odd number of boundary edges, and each is an open loop.
//
// Triangles with two corners at one place have no area and do not count. Cost: n log n.
std::vector<TrueLoop> mesh_boundary(std::span<const Triangle> triangles,
                                    std::span<const std::uint64_t> stand_ins,
                                    std::span<const Eigen::Vector3d> positions);

}  // namespace lacuna::evaluation
