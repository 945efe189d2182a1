// SPDX-License-Identifier: Apache-2.0
// choose: chooses one point for each occupied cell of a lattice.
//
// The lattice of a level consists of cubes of one edge, counted from the origin of the coordinates. So the
// cell of a point depends on that point alone. Cells at 0 reach a quarter of an edge below it. Walls and
// floors are often at 0, and noise would share their points out among the cells of both sides.
#pragma once

#include "engine/run/parallel.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/rows.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// Where a point lies.
struct PointInCell {
  Eigen::Vector3d cell;   // whole numbers
  double squared_offset;  // squared distance to the cell's middle, in edges
  std::uint64_t hash;     // of the cell
};

std::uint64_t hash_of(const Eigen::Vector3d& cell);

inline constexpr double kBelowOrigin = 0.25;  // in edges: how far the cells at 0 reach

class Lattice {
 public:
  explicit Lattice(double edge) : per_length_(1 / edge) {}  // edge: above 0

  // Returns the place of a point. Its cell is not finite where the coordinates are too large for the edge.
  PointInCell place_of(const Eigen::Vector3d& position) const;

 private:
  double per_length_;
};

// A point of the input and the point that represents it. A point may represent itself.
struct Represented {
  PointId representative;
  PointId id;
};

// Ids of representatives per list of represented points.
inline constexpr std::uint64_t kRepresentedBlock = 1 << 17;

struct ChosenPoints {
  TileRange tiles;  // from which they are chosen
  RowSet rows;
  std::vector<std::uint32_t> in_cell;  // how many of each cell of the store
  std::uint64_t count = 0;
  // By block of the representative's id: all stored points and their copies. Empty where nobody wants it.
  std::optional<AppendLists<Represented>> represented;
};

// The point nearest to the middle of a cell represents it. Among equally near points, the point with the
// lowest coordinates is chosen, by x first. So the choice depends on the points alone. Parts of a scan may be
// thinned apart, and then their representatives again. Each tile chooses among its points and those of other
// tiles in the same cells. So `tiles` may be a part of the store. Throws `Error` where a coordinate is too
// large for the edge. Cost: linear. Memory: the tiles at work, a bit a row and 4 bytes a cell of the store.
// `represented_ids`: all ids are below it; 0: nobody wants to know which point represents which.
ChosenPoints choose_points(const TileStore& store, const TileRange& tiles, double edge,
                           std::uint64_t represented_ids, const Spill& spill, const Workers& workers);

}  // namespace lacuna
