// rims: the closed curves along which agreed triangles end, followed from wedge to wedge.
#pragma once

#include "engine/boundary/tangential/stored_stars.hpp"
#include "engine/config.hpp"
#include "engine/model/boundary_graph.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna {

// A point of a rim. A point with several wedges is on several rims, or several times on one.
struct CurvePoint {
  Vertex vertex;
  float room;  // of the wedge
};

// The wedges at the other ends of a wedge's two boundary edges, `from` first; kNoIndex: not among these
// wedges.
using WedgePartners = std::array<LocalIndex, 2>;

// Of each wedge. `wedges`: in ascending row. Cost: linear.
std::vector<WedgePartners> partners_of(std::span<const Wedge> wedges);

// visit(curve) for each closed curve, but for those of wedges that are `left_out`: whole components of the
// boundary graph, such as leave the tile. The start and the direction of a curve do not depend on the order
// of the wedges of a point. Cost: linear.
void follow_curves(std::span<const Wedge> wedges, std::span<const WedgePartners> partners,
                   std::vector<bool> left_out, const std::function<void(std::vector<CurvePoint>&)>& visit);

// Turns a rim so that it starts at its smallest id and goes on to that one's smaller neighbour (of several
// such ways the one whose ids come first).
void normalise(std::vector<CurvePoint>& rim);

// A rim passes a point twice where two holes touch: parts it into curves that pass each point once. Whenever
// it comes back to a point, what lies between is a curve. Of one that is normalised; the curves are, too.
std::vector<std::vector<CurvePoint>> split_at_pinches(std::vector<CurvePoint> rim);

// How sure it is that the rim is that of a hole, in [0, 1]: where the scan only happens to be thin, a larger
// ball fits at few points of the rim. A point counts in proportion to its room, fully from 3.5 on
// (`clear_excess`). The mean of that, with five more points that have none (`doubt`): a few points may have
// room by chance. The sum is taken in the order of the rim.
double confidence(std::span<const CurvePoint> rim, const TangentialConfig& config);

}  // namespace lacuna
