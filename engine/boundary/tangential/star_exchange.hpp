// SPDX-License-Identifier: Apache-2.0
// The data that crosses tiles while the stars of their belts are measured.
#pragma once

#include "engine/boundary/tangential/star_streams.hpp"
#include "engine/model/tiling.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/row_numbers.hpp"
#include "engine/store/row_set.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::tangential {

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

}  // namespace lacuna::tangential
