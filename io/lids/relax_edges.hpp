// SPDX-License-Identifier: Apache-2.0
// relax_edges: better triangles between the same vertices.
// Liepa, *Filling holes in meshes*, SGP 2003, section 4.
#pragma once

#include "io/lids/lid_mesh.hpp"

namespace lacuna::io {

// Swaps each inner edge whose opposite angles sum to more than half a turn, until none is left or after 30
// rounds. Edges stay where the new edge exists already. In a plane, the area is the same afterwards, and the
// triangulation is the constrained Delaunay one. Cost: linear for each round.
void relax_edges(LidMesh& mesh);

}  // namespace lacuna::io
