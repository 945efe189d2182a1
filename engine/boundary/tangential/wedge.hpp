// Boundary wedges: the records of the boundary graph.
#pragma once

#include "engine/model/boundary_graph.hpp"

namespace lacuna {

// A point at the boundary of the consistent triangles, and the ends of its two boundary edges. Between these
// edges, around the point, there is no consistent triangle.
struct Wedge {
  Vertex point;
  Row from, to;
  float excess;  // radius, of the largest ball in the wedge
};

}  // namespace lacuna
