// SPDX-License-Identifier: Apache-2.0
// curves: the closed curves along which consistent triangles end, followed from wedge to wedge (method.md,
// C.5).
#pragma once

#include "engine/boundary/tangential/wedge.hpp"
#include "engine/config/config.hpp"
#include "engine/store/scratch.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna::tangential {

// A point of a curve. A point with several wedges is on several curves, or several times on one.
struct CurvePoint {
  StoredLoopPoint point;
  WedgeEvidence evidence;

  PointId id() const { return point.point.id; }
};

// The wedges of the same scale at the other ends of a wedge's two boundary edges, `from` first; kNoIndex: not
// among these wedges.
using WedgePartners = std::array<LocalIndex, 2>;

// Returns the partners of each wedge. `wedges`: in ascending row. Cost: linear.
std::vector<WedgePartners> partners_of(std::span<const Wedge> wedges);

// Wedges one after the other along boundary edges, by their numbers. An open chain begins and ends at wedges
// without a partner on that side; `first_side` and `last_side` say which.
struct WedgeChain {
  std::span<const LocalIndex> wedges;
  bool is_closed;
  std::size_t first_side, last_side;  // 0: from; 1: to
};

// visit(chain) for each; all wedges are in one. Their starts and directions depend on the order of the
// wedges. Cost: linear.
void follow_wedges(std::span<const Wedge> wedges, std::span<const WedgePartners> partners,
                   const std::function<void(const WedgeChain&)>& visit);

// The curve starts at its smallest id and goes on to the smaller neighbour of that one. Of several such ways,
// it takes the one whose ids come first.
void normalise(std::span<const CurvePoint> curve, std::span<CurvePoint> turned, Scratch& scratch);

// visit(curve): a curve passes a point twice where two holes touch, and is split there into curves that pass
// each point once. When it comes back to a point, the part in between is a curve. All are normalised.
void split_at_pinches(std::span<const CurvePoint> curve, Scratch& scratch,
                      const std::function<void(std::span<const CurvePoint>)>& visit);

// What says whether a curve bounds a hole (method.md, C.6). Where a scan happens to be thin, the circumradius
// is large at few points of the curve. So its clearness is the mean one of its wedges along its length. Some
// sampling radii of length without clearness are added: a short curve may be clear by chance. The other
// values are means over its points. Sums are in the order of the curve.
LoopEvidence evidence_of(std::span<const CurvePoint> curve, Scale scale, const TangentialConfig& config,
                         Scratch& scratch);

}  // namespace lacuna::tangential
