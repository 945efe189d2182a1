// SPDX-License-Identifier: Apache-2.0
// exchange: the active points and the wedges that depend on several tiles (method.md, C.4).
//
// Idea: active points are a least fixed point, so tiles may grow them in any order, and again while a
// neighbouring tile has new ones. A tile emits the stars that others may change, and the sites of its belt.
// It takes part once a point of its belt is active, which on clean scans few tiles do.
//
// In each round, the tiles around publish their sites, and border points are sampled. Then the stars of belts
// are measured, and send their triangles to the tiles of their foreign link vertices. Active points grow
// along inconsistent triangles. New active points near a border request their tiles for the next round.
//
// Source: method.md, C.4; star splaying, Shewchuk, SoCG 2005.
// Cost: the stars of the measured belts, and the open stars once in each round.
#pragma once

#include "engine/boundary/rounds.hpp"
#include "engine/boundary/tangential/curves.hpp"
#include "engine/boundary/tangential/stars.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/model/tiling.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/rows.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::tangential {

// ---- What a tile emits of its stars

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

// ---- What crosses tiles

// The star of `from`, in another tile, has the triangle (from, to, other) at the scale; `to` is an owned
// point.
struct RemoteTriangle {
  LocalIndex to;
  Scale scale;
  Row from, other;

  friend bool operator<(const RemoteTriangle& a, const RemoteTriangle& b);
};

// Lists are by tile. Columns have the rows of the belts one after the other, tile by tile.
struct StarExchange {
  // Takes the active points that each tile has found. `outputs` must outlive this.
  StarExchange(const TileOutputs& outputs, const Tiling& tiling, const Spill& spill, const TaskArena& arena);

  // Writes the sites and samples of a tile to the columns, where other tiles read them.
  void publish(TileIndex tile);
  // Returns the places of rows in the columns. Rows are of published belts, and ascend, as places do.
  std::vector<Row> places_of(std::span<const Row> rows) const;
  // Adds the measured stars of a tile's belt to its open ones. Once for each tile.
  void add_belt_stars(TileIndex tile, const OpenStars& stars);
  // The open stars of a tile, in ascending owned index.
  OpenStars open_stars(TileIndex tile) const;
  std::uint64_t open_star_count(TileIndex tile) const;
  std::uint64_t open_vertex_count(TileIndex tile) const;

  const TileOutputs& outputs;
  const Tiling& tiling;
  RowSet active;
  std::vector<std::vector<TileIndex>> around;    // tiles that own any of the belt's rows, ascending
  Column<Site> sites;                            // of the belts' rows, by place
  Column<StarSample> samples;                    // of the same rows
  AppendLists<RemoteTriangle> remote_triangles;  // of the tile's border points

 private:
  std::vector<std::uint64_t> first_places_;  // by tile
  std::vector<RowNumbers> numbers_;          // of the tile's rows
  AppendLists<OpenStar> belt_stars_;
  AppendLists<OpenLinkVertex> belt_vertices_;
};

// ---- The rounds

// Wedges of open stars, in ascending row, and the curve point of each.
struct OpenWedges {
  std::vector<Wedge> wedges;
  std::vector<CurvePoint> points;
};

// Finds the active points and the wedges that depend on several tiles.
class BorderExchange {
 public:
  BorderExchange(const TileOutputs& outputs, const Tiling& tiling, const TangentialConfig& config,
                 const Spill& spill, const Workers& workers);

  // Finds all active points.
  void find_active_points();

  // Returns the wedges of a tile's open stars, once all active points are found. From any thread.
  OpenWedges wedges(TileIndex tile);
  std::uint64_t most_wedges(TileIndex tile) const;
  std::uint64_t growing_bytes(TileIndex tile) const;  // memory that finding them takes

 private:
  std::vector<TileIndex> with_neighbours(std::span<const TileIndex> tiles) const;
  void measure(std::span<const TileIndex> tiles);
  bool has_active_belt(TileIndex tile) const;
  void grow(TileIndex tile, Rounds& rounds);
  template <class Bytes, class Step>
  void for_each(std::span<const TileIndex> tiles, Bytes&& bytes, Step&& step);

  const TangentialConfig& config_;
  const Workers& workers_;
  StarExchange stars_;
  std::vector<std::uint8_t> is_published_, is_sampled_, is_measured_;  // by tile
};

}  // namespace lacuna::tangential
