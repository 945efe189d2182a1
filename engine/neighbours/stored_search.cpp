#include "engine/neighbours/stored_search.hpp"

#include "engine/model/neighbourhoods.hpp"
#include "engine/neighbours/block_search.hpp"

namespace lacuna {
namespace {

// A node of the tree, or a cell.
struct Place {
  double squared_distance;
  std::uint32_t index;
  bool is_cell;

  friend bool operator<(const Place& a, const Place& b) { return a.squared_distance > b.squared_distance; }
};

}  // namespace

std::vector<StoredNeighbour> StoredSearch::nearest(const StoredPoint& point, Row row, std::size_t k) {
  const Eigen::AlignedBox3d here(point.position(), point.position());
  std::priority_queue<Place> places;
  Nearest nearest;
  places.push({0, 0, false});
  while (!places.empty()) {
    const Place place = places.top();
    places.pop();
    if (nearest.size() == k && place.squared_distance > nearest.top().squared_distance) break;
    if (place.is_cell) {
      search_cell(place.index, point, row, k, nearest);
      continue;
    }
    const CellNode& node = tiling_.nodes[place.index];
    if (node.left != 0) {
      for (const std::uint32_t child : {node.left, node.right}) {
        places.push({min_squared_distance(here, tiling_.nodes[child].box), child, false});
      }
    } else {
      for (std::uint32_t c = node.first; c < node.last; ++c) {
        places.push({min_squared_distance(here, tiling_.cells[c].box), c, true});
      }
    }
  }
  std::vector<StoredNeighbour> found;
  for (; !nearest.empty(); nearest.pop()) {
    refuse_underflow(nearest.top().squared_distance, point.id, nearest.top().point.id);
    found.push_back(nearest.top());
  }
  return found;
}

void StoredSearch::search_cell(std::uint32_t cell, const StoredPoint& point, Row row, std::size_t k,
                               Nearest& nearest) {
  const std::vector<StoredPoint>& points = cached(cell);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Row other{value(tiling_.cells[cell].first_row) + i};
    const double distance = squared_distance(points[i].position(), point.position());
    if (other == row || (nearest.size() == k && distance > nearest.top().squared_distance)) continue;
    nearest.push({distance, points[i], other});
    if (nearest.size() > k) nearest.pop();
  }
}

const std::vector<StoredPoint>& StoredSearch::cached(std::uint32_t cell) {
  constexpr std::uint64_t kCachedPoints = 65'536;
  const auto [place, is_new] = cache_.try_emplace(cell);
  if (is_new) {
    cached_points_ += tiling_.cells[cell].points;
    if (cached_points_ > kCachedPoints) {
      cache_.clear();
      cached_points_ = tiling_.cells[cell].points;
      return cache_[cell] = store_.cell(cell);
    }
    place->second = store_.cell(cell);
  }
  return place->second;
}

}  // namespace lacuna
