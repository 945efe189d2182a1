#include "engine/stages/neighbourhoods.hpp"

#include "engine/stages/block_search.hpp"
#include "engine/stages/search.hpp"

#include <algorithm>
#include <optional>

namespace lacuna {
namespace {

Neighbour neighbour(const TilePoints& points, LocalIndex from, LocalIndex to) {
  return {squared_distance(points.positions[from], points.positions[to]), points.ids[to], to};
}

// N_p^k of every owned point, and the last of each in neighbour order: q is in N_p^k if it is not after it.
struct NearestLists {
  Rows lists;
  std::vector<Neighbour> last;
};

NearestLists nearest_lists(const TilePoints& points, std::size_t k) {
  NearestLists nearest;
  nearest.lists.offsets.reserve(points.owned + 1);
  nearest.lists.indices.reserve(points.owned * std::min<std::size_t>(k, points.size()));
  nearest.last.reserve(points.owned);
  BlockSearch search(points.positions, points.ids);
  search.nearest(0, points.owned, k, [&](LocalIndex, std::span<const Neighbour> found) {
    for (const Neighbour& q : found) nearest.lists.indices.push_back(q.index);
    nearest.lists.offsets.push_back(static_cast<std::uint32_t>(nearest.lists.indices.size()));
    nearest.last.push_back(found.empty() ? Neighbour{-1.0, PointId{0}, kNoIndex} : found.back());
  });
  return nearest;
}

// Row p: the owned points q with p in N_q^k but q not in N_p^k.
Rows one_sided(const TilePoints& points, const NearestLists& nearest) {
  const auto for_each_edge = [&](auto&& visit) {
    for (LocalIndex q = 0; q < points.owned; ++q) {
      for (const LocalIndex p : nearest.lists[q]) {
        if (points.is_owned(p) && nearest.last[p] < neighbour(points, p, q)) visit(p, q);
      }
    }
  };
  Rows rows;
  rows.offsets.assign(points.owned + 1, 0);
  for_each_edge([&](LocalIndex p, LocalIndex) { ++rows.offsets[p + 1]; });
  for (LocalIndex p = 0; p < points.owned; ++p) rows.offsets[p + 1] += rows.offsets[p];
  rows.indices.resize(rows.offsets.back());
  std::vector<std::uint32_t> next(rows.offsets.begin(), rows.offsets.end() - 1);
  for_each_edge([&](LocalIndex p, LocalIndex q) { rows.indices[next[p]++] = q; });
  return rows;
}

}  // namespace

Rows find_neighbourhoods(const TilePoints& points, std::size_t k, double eps) {
  const NearestLists nearest = nearest_lists(points, k);
  const Rows others = one_sided(points, nearest);
  const double squared_eps = eps * eps;
  std::optional<PointTree> tree;
  if (eps > 0) tree.emplace(points.positions, points.ids);

  Rows neighbourhoods;
  neighbourhoods.offsets.reserve(points.owned + 1);
  neighbourhoods.indices.reserve(nearest.lists.indices.size() + others.indices.size());
  std::vector<Neighbour> added, ball;
  for (LocalIndex p = 0; p < points.owned; ++p) {
    added.clear();
    const auto add = [&](LocalIndex q) {
      const Neighbour candidate = neighbour(points, p, q);
      if (nearest.last[p] < candidate) added.push_back(candidate);
    };
    for (const LocalIndex q : others[p]) add(q);
    for (const LocalIndex q : points.linked[p]) add(q);
    if (eps > 0) {
      tree->within(p, squared_eps, ball);
      std::erase_if(added, [&](const Neighbour& q) { return q.squared_distance <= squared_eps; });
      for (const Neighbour& q : ball) {
        if (nearest.last[p] < q) added.push_back(q);
      }
    }
    std::sort(added.begin(), added.end());
    const auto row = nearest.lists[p];
    neighbourhoods.indices.insert(neighbourhoods.indices.end(), row.begin(), row.end());
    for (const Neighbour& q : added) neighbourhoods.indices.push_back(q.index);
    neighbourhoods.offsets.push_back(static_cast<std::uint32_t>(neighbourhoods.indices.size()));
  }
  return neighbourhoods;
}

}  // namespace lacuna
