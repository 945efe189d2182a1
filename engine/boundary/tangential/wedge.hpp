// SPDX-License-Identifier: Apache-2.0
// Boundary wedges: the records of the boundary graph.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/config/config.hpp"
#include "engine/model/loop.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace lacuna::tangential {

// A point at the boundary of the consistent triangles, and the ends of its two boundary edges. Between these
// edges, around the point, there is no consistent triangle.
struct Wedge {
  PointId id;
  Row row, from, to;
  float radius;  // the largest circumradius in the wedge, in units of `Sampling::distance`
  Scale scale;
};

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

}  // namespace lacuna::tangential
