// Stars on their way across tiles: what a tile alone knows of its stars, and what its borders leave open.
#pragma once

#include "engine/boundary/tangential/stored_stars.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/row_set.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lacuna {

// A point with neighbours in other tiles, whose star waits for their sites, or one beside such, whose star
// waits to be measured.
struct WaitingPoint {
  LocalIndex place;  // in sight
  std::uint32_t neighbours;
  PointState state;
  double normal[3];
};

// A point that a waiting one sees.
struct NearbyPoint {
  Vertex vertex;
  Sampling sampling;  // none of border points: theirs come later
};

// Stars by tile. Those of a tile are appended in one go or in several, by one thread at a time.
class StarSpill {
 public:
  StarSpill(const Job& job, const std::string& name, std::size_t tiles, std::uint64_t budget);

  void append(TileIndex tile, StoredStars stars);
  StoredStars read(TileIndex tile) const;  // in ascending owned index
  void drop(TileIndex tile);

 private:
  AppendLists<StoredStar> stars_;
  AppendLists<StoredLinkVertex> corners_;
};

// What the default method keeps of the tiles; lists are by tile unless said otherwise.
struct StarLists {
  StarLists(const TileStore& store, const Job& job);

  void drop_waiting(TileIndex tile);  // all but the wedges

  AppendLists<WaitingPoint> waiting;           // in ascending owned index
  AppendLists<LocalIndex> waiting_neighbours;  // of one after the other, in neighbour order: places in sight
  AppendLists<NearbyPoint> waiting_nearby;     // these points and their neighbours, in ascending row
  std::vector<std::vector<TileIndex>> around;  // tiles with these points, in ascending order
  Column<Site> sites;                          // by row, of border points and their neighbours
  RowSet active;
  RowSet unmeasured;               // of waiting points, those whose stars are not measured yet
  StarSpill found;                 // stars of waiting points as they are found
  StarSpill open;                  // measured stars
  AppendLists<Wedge> wedges;       // of settled ones
  AppendLists<Wedge> open_wedges;  // of the others (passes/seams)
};

}  // namespace lacuna
