// rims: the closed curves along which agreed triangles end, followed from gap to gap.
#pragma once

#include "engine/data/component.hpp"
#include "engine/data/stored_stars.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna {

// A point of a rim. A point with several gaps is on several rims, or several times on one.
struct RimPoint {
  Vertex vertex;
  float room, unevenness;  // of the gap
};

// visit(curve) for each closed curve of the wedges, which come in any order. Every curve is whole: where a wedge ends,
// another one begins. Each curve once; the order, start and direction do not depend on that of the wedges. Cost: n log n.
void follow_curves(std::vector<Gap> wedges, const std::function<void(std::vector<RimPoint>&)>& visit);

// Turns a rim so that it starts at its smallest id and goes on to that one's smaller neighbour (of several
// such ways the one whose ids come first).
void normalise(std::vector<RimPoint>& rim);

// A rim passes a point twice where two holes touch: parts it into curves that pass each point once. Whenever
// it comes back to a point, what lies between is a curve. Of one that is normalised; the curves are, too.
std::vector<std::vector<RimPoint>> split_at_pinches(std::vector<RimPoint> rim);

// How sure it is that the rim is that of a hole, in [0, 1]: where the scan only happens to be thin, a larger
// ball fits at few points of the rim. The share of points at which there is room of 1.5, or 1.25 times the
// share with room of 2.5, if that is less; out of some points more than there are, so that small rims need
// room all around: 42 times the mean unevenness, at most six. Where points lie evenly none has room by
// chance.
double confidence(std::span<const RimPoint> rim);

}  // namespace lacuna
