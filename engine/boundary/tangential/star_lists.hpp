// SPDX-License-Identifier: Apache-2.0
// What the tangential method keeps of the tiles until all of them are evaluated.
#pragma once

#include "engine/boundary/tangential/sampling_radius.hpp"
#include "engine/boundary/tangential/stars.hpp"
#include "engine/boundary/tangential/wedge.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/row_set.hpp"
#include "engine/store/tile_store.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lacuna::tangential {

// A point of a tile's belt: it has neighbours in other tiles (border), or neighbours that have.
struct BeltPoint {
  PointId id;
  LocalIndex owned;
  LocalIndex place;  // among the rows of the belt
  std::uint32_t neighbours;
  double normal[3];
  bool is_border;
};

// A measured star some of whose triangles depend on other tiles. Its link goes by rows, which all tiles know.
struct OpenStar {
  PointId id;
  LocalIndex owned;
  StarPlace place;                                     // among the tile's open link vertices
  double distance;                                     // `Sampling::distance`
  std::array<double, kScales.size()> sampling_radius;  // by scale
  float surface;                                       // mean surface share of the point's neighbours
};

// A link vertex of an open star, with the consistency of the triangle that begins here.
struct OpenLinkVertex {
  Row point;
  double length;  // from the star's point
  float radius;
  Consistency consistency;
};
template <class Visit>
void for_each_row(OpenLinkVertex& record, Visit&& visit) {
  visit(record.point);
}

// Open stars of one tile.
struct OpenStars {
  std::vector<OpenStar> stars;
  std::vector<OpenLinkVertex> vertices;

  void add(PointId id, LocalIndex owned, const RadiusBound& bound, double distance,
           SamplingRadius& sampling_radius, float surface) {
    stars.push_back(
        {id,
         owned,
         {static_cast<std::uint32_t>(vertices.size()), 0, bound},
         distance,
         {sampling_radius.within(bound.fine * distance), sampling_radius.within(bound.coarse * distance)},
         surface});
  }
  void add_vertex(const OpenLinkVertex& vertex) {  // of the last star
    vertices.push_back(vertex);
    ++stars.back().place.size;
  }
};

// The star of `from`, in another tile, has the triangle (from, to, other) at the scale; `to` is an owned
// point.
struct RemoteTriangle {
  LocalIndex to;
  Scale scale;
  Row from, other;

  friend bool operator<(const RemoteTriangle& a, const RemoteTriangle& b);
};

// What the stars around one need of it.
struct StarSample {
  Sampling sampling;
  StarRadii radii;
  float surface;  // `Evaluation::surface_share`
};

// Lists are by tile.
struct StarLists {
  StarLists(const TileStore& store, const Job& job);

  // A tile's open stars are appended in one go or in several, by one thread at a time.
  void append_open(TileIndex tile, OpenStars stars);
  OpenStars read_open(TileIndex tile) const;  // in ascending owned index
  void drop(TileIndex tile);                  // all but the wedges

  AppendLists<BeltPoint> belt;  // in ascending owned index
  AppendLists<Row> belt_rows;   // of these points and their neighbours, ascending
  AppendLists<LocalIndex>
      belt_neighbours;  // of one point after the other, in neighbour order: places of rows
  std::vector<std::vector<TileIndex>> around;  // tiles that own any of the belt's rows, ascending
  // By row, of the belts' rows. Each tile writes its own points.
  Column<Site> sites;
  Column<StarSample> samples;

  RowSet active;
  AppendLists<OpenStar> open_stars;
  AppendLists<OpenLinkVertex> open_vertices;
  AppendLists<RemoteTriangle> remote_triangles;  // of the tile's border points
  AppendLists<Wedge> wedges;                     // in two runs of ascending row
};

}  // namespace lacuna::tangential
