// SPDX-License-Identifier: Apache-2.0
#include "engine/neighbours/store_search.hpp"

#include "engine/model/least_first.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/neighbours/block_search.hpp"

namespace lacuna {

std::vector<StoreNeighbour> StoreSearch::nearest(const ScanPoint& point, Row row, std::size_t k) {
  const Eigen::AlignedBox3d here(point.position(), point.position());
  Nearest nearest;
  for_each_cell_least_first(
      tiling_, [&](const Eigen::AlignedBox3d& box) { return min_squared_distance(here, box); },
      [&](double distance) { return nearest.size() == k && distance > nearest.top().squared_distance; },
      [](const CellNode&) { return true; },
      [&](std::uint32_t cell) { search_cell(cell, point, row, k, nearest); });
  std::vector<StoreNeighbour> found;
  for (; !nearest.empty(); nearest.pop()) {
    refuse_underflow(nearest.top().squared_distance, point.id, nearest.top().id);
    found.push_back(nearest.top());
  }
  return found;
}

void StoreSearch::search_cell(std::uint32_t cell, const ScanPoint& point, Row row, std::size_t k,
                              Nearest& nearest) {
  const std::vector<ScanPoint>& points = cached(cell);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Row other{value(tiling_.cells[cell].first_row) + i};
    const double distance = squared_distance(points[i].position(), point.position());
    if (other == row || (nearest.size() == k && distance > nearest.top().squared_distance)) continue;
    nearest.push({points[i], distance, other});
    if (nearest.size() > k) nearest.pop();
  }
}

const std::vector<ScanPoint>& StoreSearch::cached(std::uint32_t cell) {
  constexpr std::uint64_t kCachedPoints = 65'536;
  if (const auto found = cache_.find(cell); found != cache_.end()) return found->second;
  const std::uint64_t points = tiling_.cells[cell].points;
  if (cached_points_ + points > kCachedPoints) {
    cache_.clear();
    cached_points_ = 0;
  }
  cached_points_ += points;
  return cache_[cell] = store_.cell(cell);
}

}  // namespace lacuna
