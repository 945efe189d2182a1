// SPDX-License-Identifier: Apache-2.0
#include "engine/neighbours/neighbourhoods.hpp"

#include "engine/neighbours/block_search.hpp"
#include "engine/neighbours/nearest_lists.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <limits>
#include <memory>

namespace lacuna {
namespace {

constexpr LocalIndex kTogether = 64;  // points searched together

// Finds N_p^k of every owned point.
class Nearest {
 public:
  Nearest(BlockSearch& search, const TilePoints& points, std::size_t k) {
    const std::size_t count = search.neighbours_of(k), stride = (count + kListLine - 1) / kListLine;
    lines_ = std::make_unique_for_overwrite<ListLine[]>(stride * points.owned);
    mutual_ = std::make_unique_for_overwrite<std::uint16_t[]>(stride * points.owned);
    lists_ = {lines_.get(), stride, count, mutual_.get()};
    for (LocalIndex first = 0; first < points.owned; first += kTogether) {
      const LocalIndex last = std::min(first + kTogether, points.owned);
      const BlockSearch::Lists lists{lines_[first * stride].points, stride * kListLine};
      search.nearest(first, last, k, lists);
      for (LocalIndex p = first; p < last; ++p)
        std::fill(lists[p - first] + count, lists[p - first] + lists.stride, kNoIndex);
      // This happens now, since the lists before are still in the cache.
      find_mutual(lists_, first, last);
    }
  }

  const NearestLists& lists() const { return lists_; }
  std::span<const LocalIndex> operator[](LocalIndex p) const {
    return {lists_.lines[p * lists_.stride].points, lists_.count};
  }
  // Copies the list of p, in whole lines; returns where the next one goes.
  LocalIndex* copy(LocalIndex p, LocalIndex* to) const {
    for (std::size_t line = 0; line < lists_.stride; ++line)
      std::copy_n(lists_.lines[p * lists_.stride + line].points, kListLine, to + line * kListLine);
    return to + lists_.count;
  }
  bool holds(LocalIndex p, LocalIndex q) const {
    const auto list = (*this)[p];
    return std::find(list.begin(), list.end(), q) != list.end();
  }

 private:
  std::unique_ptr<ListLine[]> lines_;
  std::unique_ptr<std::uint16_t[]> mutual_;
  NearestLists lists_{};
};

// List q has the owned points p with q in N_p^k but p not in N_q^k.
Neighbourhoods one_sided(const TilePoints& points, const Nearest& nearest) {
  const std::size_t most = kTogether * nearest.lists().count + kListLine;
  std::vector<std::uint32_t> q, p;
  std::size_t count = 0;
  for (LocalIndex first = 0; first < points.owned; first += kTogether) {
    if (q.size() < count + most) {
      q.resize(2 * (count + most));
      p.resize(q.size());
    }
    const LocalIndex last = std::min(first + kTogether, points.owned);
    count += find_one_sided(nearest.lists(), first, last, points.owned, {q.data() + count, p.data() + count});
  }
  Neighbourhoods lists;
  lists.offsets.assign(points.owned + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++lists.offsets[q[i] + 1];
  for (LocalIndex q = 0; q < points.owned; ++q) lists.offsets[q + 1] += lists.offsets[q];
  lists.indices.resize(count);
  std::vector<std::uint32_t> next(lists.offsets.begin(), lists.offsets.end() - 1);
  for (std::size_t i = 0; i < count; ++i) lists.indices[next[q[i]]++] = p[i];
  return lists;
}

// Places in a tile's neighbourhoods are 32 bit numbers.
void check_count(std::uint64_t neighbours) {
  if (neighbours > std::numeric_limits<std::uint32_t>::max())
    throw Error(
        "the neighbourhoods of a tile hold more than 2^32 points; a smaller eps or tile_points is needed");
}

// Finds the points within eps of every owned point, in neighbour order.
Neighbourhoods balls(BlockSearch& search, const TilePoints& points, double eps) {
  Neighbourhoods lists;
  if (eps == 0) {
    lists.offsets.resize(points.owned + 1);
    return lists;
  }
  search.within(0, points.owned, eps, [&](LocalIndex, std::span<const LocalIndex> found) {
    check_count(lists.indices.size() + found.size());
    lists.indices.insert(lists.indices.end(), found.begin(), found.end());
    lists.offsets.push_back(static_cast<std::uint32_t>(lists.indices.size()));
  });
  return lists;
}

}  // namespace

Neighbourhoods find_neighbourhoods(const TilePoints& points, std::size_t k, double eps) {
  BlockSearch search(points.positions, points.ids);
  const Nearest nearest(search, points, k);
  const Neighbourhoods others = one_sided(points, nearest);
  const Neighbourhoods near = balls(search, points, eps);
  const double squared_eps = eps * eps;

  Neighbourhoods neighbourhoods;
  neighbourhoods.offsets.reserve(points.owned + 1);
  std::vector<LocalIndex>& indices = neighbourhoods.indices;
  const std::uint64_t most = points.owned * nearest.lists().count + others.indices.size() +
                             points.linked.indices.size() + near.indices.size() + kListLine;
  check_count(most);
  indices.resize(most);
  LocalIndex* end = indices.data();
  std::vector<Neighbour> added;
  for (LocalIndex p = 0; p < points.owned; ++p) {
    end = nearest.copy(p, end);

    // Either the k nearest hold all points within eps, or the reverse: both begin alike.
    const auto beyond = near[p].subspan(std::min(nearest.lists().count, near[p].size()));
    end = std::copy(beyond.begin(), beyond.end(), end);

    // Points in neither come after both.
    added.clear();
    const auto add = [&](LocalIndex q) {
      const double distance = squared_distance(points.positions[p], points.positions[q]);
      if (eps == 0 || distance > squared_eps) added.push_back({distance, points.ids[q], q});
    };
    for (const LocalIndex q : others[p]) add(q);
    for (const LocalIndex q : points.linked[p]) {
      if (!nearest.holds(p, q)) add(q);
    }
    std::sort(added.begin(), added.end());
    for (const Neighbour& q : added) *end++ = q.index;
    neighbourhoods.offsets.push_back(static_cast<std::uint32_t>(end - indices.data()));
  }
  indices.resize(static_cast<std::size_t>(end - indices.data()));
  return neighbourhoods;
}

}  // namespace lacuna
