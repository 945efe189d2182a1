// rims: the closed curves along which agreed triangles end, followed from gap to gap.
#pragma once

#include "engine/config.hpp"
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
  float room;  // of the gap
};

// A rim, or the part of one that lies in a tile: consecutive points.
struct RimPart {
  std::vector<RimPoint> points;
  bool is_closed = false;
  Row before{}, after{};  // unless closed: what the rim comes from and goes to
};

// `gaps`: of points with rows in [first, last), in ascending row of the point. Each rim and part once, in any
// order and direction. Linear in gaps and rows.
void follow_rims(std::span<const Gap> gaps, Row first, Row last, const std::function<void(RimPart&)>& visit);

// Turns a rim so that it starts at its smallest id and goes on to that one's smaller neighbour (of several
// such ways the one whose ids come first).
void normalise(std::vector<RimPoint>& rim);

// A rim passes a point twice where two holes touch: parts it into curves that pass each point once. Whenever
// it comes back to a point, what lies between is a curve. Of one that is normalised; the curves are, too.
std::vector<std::vector<RimPoint>> split_at_pinches(std::vector<RimPoint> rim);

// How sure it is that the rim is that of a hole, in [0, 1]: where the scan only happens to be thin, a larger
// ball fits at few points of the rim. A point counts in proportion to its room, fully from 3.5 on
// (`clear_excess`). The mean of that, with five more points that have none (`doubt`): a few points may have
// room by chance. The sum is taken in the order of the rim.
double confidence(std::span<const RimPoint> rim, const TangentialConfig& config);

}  // namespace lacuna
