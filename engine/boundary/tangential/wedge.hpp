// SPDX-License-Identifier: Apache-2.0
// Boundary wedges: the records of the boundary graph.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/config/config.hpp"
#include "engine/model/boundary_graph.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::tangential {

// What confidence needs of a wedge (method.md, C.6). Lengths are in units of the scan.
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
  Vertex point;
  Row from, to;
  WedgeEvidence evidence;
  Scale scale;
};
template <class Visit>
void for_each_row(Wedge& record, Visit&& visit) {
  visit(record.point.row);
  visit(record.from);
  visit(record.to);
}

// 0 where the circumradius is no larger than the sampling radius, 1 from `clear_radius` times that on.
inline float clearness(double radius, double sampling_radius, const TangentialConfig& config) {
  return static_cast<float>(std::clamp((radius / sampling_radius - 1) / (config.clear_radius - 1), 0.0, 1.0));
}

// Adds the wedges of a star's point at both scales. `distance`: `Sampling::distance`; sampling_radius(scale)
// and surface(): of the point; row(i), length(i): of link vertex i, and its distance from the point.
template <class Name, class Radius, class Surface, class LinkRow, class LinkLength>
void add_wedges(const Vertex& point, const Star<Name>& star, std::span<const Consistency> consistencies,
                double distance, Radius&& sampling_radius, Surface&& surface, LinkRow&& row,
                LinkLength&& length, const TangentialConfig& config, std::vector<Wedge>& wedges) {
  std::optional<float> around;
  for (const Scale scale : kScales) {
    std::optional<double> sampling;
    for_each_wedge(star, consistencies, scale, [&](std::size_t first, std::size_t last, float radius) {
      if (!sampling) sampling = sampling_radius(scale);
      if (!around) around = surface();
      wedges.push_back({point,
                        row(first),
                        row(last),
                        {(length(first) + length(last)) / 2, *sampling, distance,
                         clearness(radius * distance, *sampling, config), *around},
                        scale});
    });
  }
}

}  // namespace lacuna::tangential
