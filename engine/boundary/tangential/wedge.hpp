// SPDX-License-Identifier: Apache-2.0
// Boundary wedges: the records of the boundary graph.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/config/config.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/loops/loops.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::tangential {

// The evidence of a wedge, on which confidence depends (method.md, C.6). Lengths are in units of the scan.
struct WedgeEvidence {
  double length = 0;           // of the curve at the point: half of its two boundary edges
  double sampling_radius = 0;  // of the point, at the scale of the wedge
  double distance = 0;         // `Sampling::distance`
  float clearness = 0;         // of the gap, [0, 1]: how much the circumradius exceeds the sampling radius
  float surface = 0;           // mean surface share of the point's neighbours, [0, 1]
};

// A point at the boundary of the consistent triangles, and the ends of its two boundary edges. Between these
// edges, around the point, there is no consistent triangle.
struct Wedge {
  LoopPoint point;
  Row row, from, to;
  WedgeEvidence evidence;
  Scale scale;
};

// Returns 0 where the circumradius is no larger than the sampling radius, and 1 from `clear_radius` times
// that on.
inline float clearness(double radius, double sampling_radius, const TangentialConfig& config) {
  return static_cast<float>(std::clamp((radius / sampling_radius - 1) / (config.clear_radius - 1), 0.0, 1.0));
}

// The point of a star, with the data that its wedges need.
struct StarPoint {
  LoopPoint point;
  Row row;
  double distance;  // `Sampling::distance`
};

// What lies around the point of a star.
struct WedgeSurroundings {
  double sampling_radius;  // at the scale of a wedge
  float surface;           // mean surface share of the point's neighbours, [0, 1]
};

// A link vertex of a star.
struct LinkEnd {
  Row row;
  double length;  // from the star's point
};

// Adds the wedges of a star at both scales. around(scale): its `WedgeSurroundings`, looked up at most once
// for each scale; end(i): link vertex i.
template <class Name, class Around, class End>
void add_wedges(const StarPoint& point, const Star<Name>& star, std::span<const Consistency> consistencies,
                Around&& around, End&& end, const TangentialConfig& config, std::vector<Wedge>& wedges) {
  for (const Scale scale : kScales) {
    std::optional<WedgeSurroundings> here;
    for_each_wedge(star, consistencies, scale, [&](std::size_t first, std::size_t last, float radius) {
      if (!here) here = around(scale);
      const LinkEnd from = end(first), to = end(last);
      wedges.push_back(
          {.point = point.point,
           .row = point.row,
           .from = from.row,
           .to = to.row,
           .evidence = {.length = (from.length + to.length) / 2,
                        .sampling_radius = here->sampling_radius,
                        .distance = point.distance,
                        .clearness = clearness(radius * point.distance, here->sampling_radius, config),
                        .surface = here->surface},
           .scale = scale});
    });
  }
}

}  // namespace lacuna::tangential
