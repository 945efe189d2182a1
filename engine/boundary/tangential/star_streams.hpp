// SPDX-License-Identifier: Apache-2.0
// The data of its stars that a tile emits for the exchange between tiles.
#pragma once

#include "engine/boundary/tangential/sampling_radius.hpp"
#include "engine/boundary/tangential/stars.hpp"
#include "engine/boundary/tangential/wedge.hpp"
#include "engine/evaluate/tile_outputs.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lacuna::tangential {

// A point of a tile's belt: it has neighbours in other tiles (border), or a neighbour that has.
struct BeltPoint {
  LoopPoint point;
  LocalIndex owned;
  LocalIndex place;  // among the rows of the belt
  std::uint32_t neighbours;
  double normal[3];
  bool is_border;
};

// A measured star some of whose triangles depend on other tiles. Its link goes by rows, which all tiles know.
struct OpenStar {
  LoopPoint point;
  LocalIndex owned;
  StarRange place;                                     // among the tile's open link vertices
  double distance;                                     // `Sampling::distance`
  std::array<double, kScales.size()> sampling_radius;  // by scale
  float surface;                                       // mean surface share of the point's neighbours
};

// A link vertex of an open star, with the consistency of the triangle that begins here.
struct OpenLinkVertex {
  Row row;
  double length;  // from the star's point
  float radius;
  Consistency consistency;
};

// Open stars of one tile.
struct OpenStars {
  std::vector<OpenStar> stars;
  std::vector<OpenLinkVertex> vertices;

  // Adds a measured star, with what lies around it. end_of(q): row and distance of a link vertex.
  // consistency_of(i): of triangle i.
  template <class EndOf, class ConsistencyOf>
  void add(const LoopPoint& point, LocalIndex owned, const Star<LocalIndex>& star, double distance,
           const RadiiAround& around, float surface, EndOf&& end_of, ConsistencyOf&& consistency_of) {
    stars.push_back(
        {point,
         owned,
         {static_cast<std::uint32_t>(vertices.size()), static_cast<std::uint32_t>(star.size()), star.bound},
         distance,
         {around.sampling_radius(star.bound.fine * distance),
          around.sampling_radius(star.bound.coarse * distance)},
         surface});
    for (std::size_t i = 0; i < star.size(); ++i) {
      const auto [row, length] = end_of(star.link[i].point);
      vertices.push_back({row, length, star.link[i].radius, consistency_of(i)});
    }
  }
};

// The data of a point that the stars around it need.
struct StarSample {
  Sampling sampling;
  StarRadii radii;
  float surface;  // `Evaluation::surface_share`
};

inline constexpr RecordStream<LocalIndex> kActive{"active"};       // owned points, ascending
inline constexpr RecordStream<OpenStar> kOpenStars{"open stars"};  // in ascending owned index
inline constexpr RecordStream<OpenLinkVertex> kOpenVertices{"open vertices"};
inline constexpr RecordStream<BeltPoint> kBelt{"belt"};     // in ascending owned index
inline constexpr RecordStream<Row> kBeltRows{"belt rows"};  // of belt points and their neighbours, ascending
// The neighbours of one belt point after the other, in neighbour order: places of rows.
inline constexpr RecordStream<LocalIndex> kBeltNeighbours{"belt neighbours"};
// Owned points among the rows of the belt, ascending; their sites and samples.
inline constexpr RecordStream<LocalIndex> kSampled{"sampled"};
inline constexpr RecordStream<Site> kSites{"sites"};
inline constexpr RecordStream<StarSample> kSamples{"samples"};

}  // namespace lacuna::tangential
