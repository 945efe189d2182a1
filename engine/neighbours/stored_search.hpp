// SPDX-License-Identifier: Apache-2.0
// stored_search: finds the k nearest neighbours of single points of the tile store.
#pragma once

#include "engine/store/tile_store.hpp"

#include <cstddef>
#include <cstdint>
#include <queue>
#include <unordered_map>
#include <vector>

namespace lacuna {

struct StoredNeighbour {
  double squared_distance;
  StoredPoint point;
  Row row;

  // The order of neighbours.
  friend bool operator<(const StoredNeighbour& a, const StoredNeighbour& b) {
    return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                    : a.point.id < b.point.id;
  }
};

// The search goes through the tree of cells, best first. Cells are read as they come, and kept while they are
// few. Not for use from several threads at once.
class StoredSearch {
 public:
  explicit StoredSearch(const TileStore& store) : store_(store), tiling_(store.tiling()) {}

  // Returns the k nearest of all other points, in no order, or all of them where fewer exist. Throws `Error`
  // if a squared distance underflows.
  std::vector<StoredNeighbour> nearest(const StoredPoint& point, Row row, std::size_t k);

 private:
  using Nearest = std::priority_queue<StoredNeighbour>;
  void search_cell(std::uint32_t cell, const StoredPoint& point, Row row, std::size_t k, Nearest& nearest);
  const std::vector<StoredPoint>& cached(std::uint32_t cell);

  const TileStore& store_;
  const Tiling& tiling_;
  std::unordered_map<std::uint32_t, std::vector<StoredPoint>> cache_;
  std::uint64_t cached_points_ = 0;
};

}  // namespace lacuna
