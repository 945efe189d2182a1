// SPDX-License-Identifier: Apache-2.0
// curves: follows closed curves from wedge to wedge. Consistent triangles end along these curves (method.md,
// C.5).
#pragma once

#include "engine/boundary/tangential/wedge.hpp"
#include "engine/config/config.hpp"
#include "engine/store/scratch.hpp"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace lacuna::tangential {

// A step along a curve: its point, and the number of its wedge.
struct CurveStep {
  PointId id;
  std::uint64_t wedge;
};

// What is known of wedges, by their numbers.
struct WedgeData {
  std::function<CurvePoint(std::uint64_t)> point;
  std::function<float(std::uint64_t)> surface;  // of that point: costs less than all of it
};

// The wedges of the same scale at the other ends of a wedge's two boundary edges. `from` comes first.
// kNoIndex: that wedge is not in the given array.
using WedgePartners = std::array<LocalIndex, 2>;

// Returns the partners of each wedge. `wedges`: in ascending row. Cost: linear.
std::vector<WedgePartners> partners_of(std::span<const Wedge> wedges);

// Wedges one after the other along boundary edges, by their numbers. An open chain begins and ends at wedges
// without a partner on that side. `first_side` and `last_side` say which side.
struct WedgeChain {
  std::span<const LocalIndex> wedges;
  bool is_closed;
  std::size_t first_side, last_side;  // 0: from; 1: to
};

// Calls visit(chain) for each chain. Every wedge is in one chain. The starts and directions of chains depend
// on the order of the wedges. Cost: linear.
void follow_wedges(std::span<const Wedge> wedges, std::span<const WedgePartners> partners,
                   const std::function<void(const WedgeChain&)>& visit);

// Writes the curve from its smallest id on, towards the smaller neighbour of that point. If several ways fit,
// it takes the way whose ids come first.
void normalise(std::span<const CurveStep> curve, std::span<CurveStep> turned, Scratch& scratch);

// Calls visit(curve) for curves that pass each point once. A curve passes a point twice where two holes
// touch, and is split there. When the curve comes back to a point, the part in between is a curve. The curve
// is passed from the place that comes last, so the parts do not depend on ids. All parts are normalised.
using PlaceOfStep = std::function<std::array<double, 3>(const CurveStep&)>;
void split_at_pinches(std::span<const CurveStep> curve, const PlaceOfStep& place_of_step, Scratch& scratch,
                      const std::function<void(std::span<const CurveStep>)>& visit);

// Returns the evidence that a curve bounds a hole (method.md, C.6). Where a scan is thin by chance, the
// circumradius is large at a few points of the curve. So its clearness is the mean clearness of its wedges
// along its length. Some sampling radii of length without clearness are added: a short curve may be clear by
// chance. The other values are means over its points. Sums are in the order of the curve. Where the surface
// alone says that there is no hole, the rest is left out: that is most curves of scans in lines.
LoopEvidence evidence_of(std::span<const CurveStep> curve, Scale scale, const WedgeData& data,
                         const TangentialConfig& config, Scratch& scratch);

// Calls visit(loop, evidence) for each loop along a closed curve: it passes each point once, has `min_curve`
// points or more, and may be a hole. Around fewer points, a sampling leaves wedges anyway.
void find_loops_along(std::span<const CurveStep> curve, Scale scale, const WedgeData& data,
                      const TangentialConfig& config, Scratch& scratch,
                      const std::function<void(std::span<const CurveStep>, const LoopEvidence&)>& visit);

}  // namespace lacuna::tangential
