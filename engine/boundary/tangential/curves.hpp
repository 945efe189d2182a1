// SPDX-License-Identifier: Apache-2.0
// curves: how boundary curves close, from wedges to loops (method.md, C.5 and C.6).
//
// Idea: each of a wedge's two boundary edges ends exactly one wedge at its other end. So wedges chain to
// closed curves without a search. A tile follows its own wedges, and leaves open chains where they end at
// other tiles; a sort of the ends of chains joins them.
//
// Most curves close within a tile, and most of them are gaps of the sampling. So a tile follows its wedges as
// soon as it knows them, and keeps loops and open chains alone.
//
// Source: method.md, C.5, whose argument is elementary.
// Cost: linear in the wedges, and a sort of the ends of open chains.
#pragma once

#include "engine/boundary/tangential/active_points.hpp"
#include "engine/config/config.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/loops/loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/stitch/stitch.hpp"
#include "engine/store/column.hpp"
#include "engine/store/scratch.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna::tangential {

// ---- Wedges: the records of the boundary graph

// A point at the boundary of the consistent triangles, and the ends of its two boundary edges. Between these
// edges, around the point, there is no consistent triangle.
struct Wedge {
  PointId id;
  Row row, from, to;
  float radius;  // the largest circumradius in the wedge, in units of `Sampling::distance`
  Scale scale;
};

// Calls visit(first, last, radius) for each boundary wedge of a star's point at a scale. A wedge is given by
// its first and last link vertex, with the largest circumradius between them. There is no wedge where no
// triangle is consistent.
template <class Name, class Visit>
void for_each_wedge(const Star<Name>& star, std::span<const Consistency> consistencies, Scale scale,
                    Visit&& visit) {
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (!consistencies[i].at(scale) || consistencies[star.next(i)].at(scale)) continue;
    const std::size_t first = star.next(i);
    std::size_t last = first;
    float largest = 0;
    for (; !consistencies[last].at(scale); last = star.next(last))
      largest = std::max(largest, star.link[last].radius);
    visit(first, last, largest);
  }
}

// Adds the wedges of the star of a point at both scales. row_of(name): the row of a link vertex.
template <class Name, class RowOf>
void add_wedges(PointId id, Row row, const Star<Name>& star, std::span<const Consistency> consistencies,
                RowOf&& row_of, std::vector<Wedge>& wedges) {
  for (const Scale scale : kScales) {
    for_each_wedge(star, consistencies, scale, [&](std::size_t first, std::size_t last, float radius) {
      wedges.push_back(
          {id, row, row_of(star.link[first].point), row_of(star.link[last].point), radius, scale});
    });
  }
}

// The evidence of a wedge, on which confidence depends (method.md, C.6). Lengths are in units of the scan.
struct WedgeEvidence {
  double length = 0;           // of the curve at the point: half of its two boundary edges
  double sampling_radius = 0;  // of the point, at the scale of the wedge
  double distance = 0;         // `Sampling::distance`
  float clearness = 0;         // of the gap, [0, 1]: how much the circumradius exceeds the sampling radius
  float surface = 0;           // mean surface share of the point's neighbours, [0, 1]
};

// A point of a curve. A point with several wedges is on several curves, or several times on one.
struct CurvePoint : LoopPoint {
  WedgeEvidence evidence;
};

// Returns 0 where the circumradius is no larger than the sampling radius, and 1 from `clear_radius` times
// that on.
inline float clearness(double radius, double sampling_radius, const TangentialConfig& config) {
  return static_cast<float>(std::clamp((radius / sampling_radius - 1) / (config.clear_radius - 1), 0.0, 1.0));
}

// ---- From wedge to wedge

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

// ---- From a closed curve to loops

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

// ---- The curves of one tile

// An end of a chain: its last point, and the other end of the boundary edge on which it leaves the tile.
struct ChainEnd {
  Row own, foreign;
};

// A chain's points lie one after the other in the column of all open chains.
struct OpenChain {
  std::uint64_t first, count;
  Scale scale;
  std::array<ChainEnd, 2> ends;  // of its first and of its last point
};

struct CurveTotals {
  std::uint64_t edges = 0;       // of the boundary graph, within the fine bound
  std::uint64_t components = 0;  // of the boundary graph, of which no chain is open
};

// Chains that leave the wedges of a tile, and what else these wedges are.
struct OpenChains {
  std::vector<OpenChain> chains;       // `first`: among `points`
  std::vector<LocalIndex> components;  // of each chain: 0, 1, 2 ... in the order of their first chains
  std::vector<CurvePoint> points;
  CurveTotals totals;

  void emit(TileOutput& output) &&;
  static OpenChains read(const TileOutputs& outputs, TileIndex tile);
  static std::uint64_t bytes(const TileOutputs& outputs, TileIndex tile);  // that `read` returns
};

// Follows wedges to curves. `wedges`: of some points of a tile, all wedges of each point, in ascending row.
// point_of(i): the curve point of wedge i. Calls visit(curve, scale) for each closed curve. Cost: linear.
OpenChains follow_curves(std::span<const Wedge> wedges,
                         const std::function<CurvePoint(std::uint64_t)>& point_of,
                         const std::function<void(std::span<const CurveStep>, Scale)>& visit);

// Loops that close within a tile.
struct TileLoops {
  struct Entry {
    std::uint64_t points;
    LoopEvidence evidence;
  };
  std::vector<Entry> loops;
  std::vector<LoopPoint> points;  // of one loop after the other

  void emit(TileOutput& output) &&;
  static TileLoops read(const TileOutputs& outputs, TileIndex tile);
  static std::uint64_t bytes(const TileOutputs& outputs, TileIndex tile);  // that `read` returns
};

// ---- Across tiles

// Receives each closed curve of whole components, with arrays of its own.
using VisitCurve = std::function<void(std::span<const CurvePoint>, Scale, Scratch&)>;

// Closes the chains of whole components. Starts and directions of curves depend on the order of the chains.
// Their arrays live in `scratch`, and a sort takes half as much. Memory of a curve: `curve_budget` bytes, and
// temporary files beyond that. Cost: linear, and a sort of the chains' ends.
void close_chains(const Stitch<OpenChain>::ForEachRecord& for_each_chain, std::uint64_t count,
                  const Column<CurvePoint>& points, std::uint64_t curve_budget, Scratch& scratch,
                  const VisitCurve& visit);

}  // namespace lacuna::tangential
