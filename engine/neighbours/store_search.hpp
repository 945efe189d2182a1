// SPDX-License-Identifier: Apache-2.0
// store_search: finds the k nearest neighbours of single points of the tile store.
#pragma once

#include "engine/store/tile_store.hpp"

#include <cstddef>
#include <cstdint>
#include <queue>
#include <unordered_map>
#include <vector>

namespace lacuna {

struct StoreNeighbour : ScanPoint {
  double squared_distance;
  Row row;

  // The order of neighbours.
  friend bool operator<(const StoreNeighbour& a, const StoreNeighbour& b) {
    return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance : a.id < b.id;
  }
};

// The search goes through the tree of cells, best first. Cells are read as they come, and kept while they are
// few. Not for use from several threads at once.
class StoreSearch {
 public:
  explicit StoreSearch(const TileStore& store) : store_(store), tiling_(store.tiling()) {}

  // Returns the k nearest of all other points, in no order, or all of them where fewer exist. Throws `Error`
  // if a squared distance underflows.
  std::vector<StoreNeighbour> nearest(const ScanPoint& point, Row row, std::size_t k);

 private:
  using Nearest = std::priority_queue<StoreNeighbour>;
  void search_cell(std::uint32_t cell, const ScanPoint& point, Row row, std::size_t k, Nearest& nearest);
  const std::vector<ScanPoint>& cached(std::uint32_t cell);

  const TileStore& store_;
  const Tiling& tiling_;
  std::unordered_map<std::uint32_t, std::vector<ScanPoint>> cache_;
  std::uint64_t cached_points_ = 0;
};

}  // namespace lacuna
