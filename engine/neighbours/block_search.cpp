// SPDX-License-Identifier: Apache-2.0
#include "engine/neighbours/block_search.hpp"

#include "engine/run/error.hpp"
#include "engine/simd/sort.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace lacuna {

// ---- The tree

BlockTree::Level::Level(std::size_t boxes) : count(boxes) {
  const std::size_t padded = (count + kFan - 1) / kFan * kFan;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis].assign(padded, BlockBox::kInfinite);
    high[axis].assign(padded, -BlockBox::kInfinite);
  }
}

void BlockTree::Level::set(std::size_t index, const BlockBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis][index] = box.low[axis];
    high[axis][index] = box.high[axis];
  }
}

BlockTree::BlockTree(std::span<const Eigen::Vector3d> positions)
    : points_(positions.size()), blocks_((positions.size() + kBlock - 1) / kBlock) {
  levels_.emplace_back(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    BlockBox box;
    const std::size_t end = std::min((b + 1) * kBlock, points_);
    if (end < (b + 1) * kBlock) std::fill_n(blocks_[b].coordinates[0], 3 * kBlock, BlockBox::kInfinite);
    for (std::size_t i = b * kBlock; i < end; ++i) {
      box.extend(positions[i]);
      for (int axis = 0; axis < 3; ++axis) blocks_[b].coordinates[axis][i % kBlock] = positions[i][axis];
    }
    levels_[0].set(b, box);
  }
  while (levels_.back().count > kFan) {
    const Level& below = levels_.back();
    Level level((below.count + kFan - 1) / kFan);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < level.count; ++i) {
        const auto low = below.low[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        const auto high = below.high[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        level.low[axis][i] = *std::min_element(low, low + kFan);
        level.high[axis][i] = *std::max_element(high, high + kFan);
      }
    }
    levels_.push_back(std::move(level));
  }
  for (const Level& level : levels_) {
    LevelSides& sides = sides_.emplace_back(LevelSides{.count = level.count});
    for (int axis = 0; axis < 3; ++axis) {
      sides.lows[axis] = level.low[axis].data();
      sides.highs[axis] = level.high[axis].data();
    }
  }
}

bool BlockTree::find_near(const BlockBox& box, double squared_radius, Surroundings& surroundings) const {
  return find_blocks(sides_.data(), sides_.size() - 1, box.low.data(), box.high.data(), squared_radius,
                     surroundings);
}

void BlockTree::fill_surroundings(Surroundings& surroundings) const {
  lacuna::fill_surroundings(blocks_.data(), sides_[0].lows, sides_[0].highs, surroundings);
}

// ---- The search

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Blocks around a run of queries are searched within this multiple of the radius for one query.
constexpr double kRunGuess = 1.3;

// Bounds are widened by more than rounding can have narrowed them.
constexpr double kSlack = 1 + 1e-12;

// Where runs extend farther than this, in units of the radius, single precision has too few digits for them.
constexpr double kLargestRun = 64;

// Squared radii in between leave digits for all distances in the surroundings.
constexpr double kLeastSquared = 1e-290, kMostSquared = 1e290;

// With this many candidates, most likely all neighbours are among them. More take longer to rank, fewer fail
// more often.
double wanted_candidates(std::size_t neighbours) {
  const double found = static_cast<double>(neighbours) + 1;  // with the query itself
  return found + 1.2 * std::sqrt(found);
}

}  // namespace

BlockSearch::BlockSearch(std::span<const Eigen::Vector3d> positions, std::span<const PointId> ids)
    : positions_(positions), ids_(ids), tree_(positions) {}

void BlockSearch::nearest(LocalIndex first, LocalIndex last, std::size_t k, Lists lists) {
  for (LocalIndex begin = first, end; begin < last; begin = end) {
    end = std::min<LocalIndex>(last, (begin / kRun + 1) * kRun);
    find(begin, end, k, {lists[begin - first], lists.stride});
  }
}

// Finds the neighbours of the queries of a run. One walk lists the points around all of them, since what is
// near in the store is near in space. Then the queries are ranked side by side. The radius is a guess from
// the query before: so few candidates are too many or too few, and only these are searched alone.
void BlockSearch::find(LocalIndex first, LocalIndex last, std::size_t k, Lists lists) {
  prepare(neighbours_of(k));
  if (neighbours_ == 0) return;
  if (guess_ == 0) guess_ = distance_to_last(first);
  list_run(first, last, first);
  rank(first, last, lists);
}

void BlockSearch::prepare(std::size_t neighbours) {
  if (neighbours == neighbours_) return;
  neighbours_ = neighbours;
  // On a surface, twice the radius holds four times the points.
  for (std::size_t found = 1; found < next_guess_.size(); ++found)
    next_guess_[found] = (1 + std::sqrt(wanted_candidates(neighbours) / static_cast<double>(found))) / 2;
}

// Calls visit(first, last) for queries that share surroundings. Where the order of points jumps, fewer
// queries share them. The surroundings of one query alone may be empty.
template <class Radius, class Visit>
void BlockSearch::for_each_run(LocalIndex first, LocalIndex last, Radius&& radius, Visit&& visit) {
  if (!find_surroundings(first, last, radius()) && last - first > 1) {
    const LocalIndex middle = first + (last - first) / 2;
    for_each_run(first, middle, radius, visit);
    for_each_run(middle, last, radius, visit);
  } else {
    visit(first, last);
  }
}

// Adds candidates for the neighbours of the queries of [first, last) to the lists of the run.
void BlockSearch::list_run(LocalIndex first, LocalIndex last, LocalIndex run) {
  const auto radius = [this] { return kRunGuess * guess_; };
  for_each_run(first, last, radius, [&](LocalIndex begin, LocalIndex end) {
    for (LocalIndex query = begin; query < end; ++query) {
      list_candidates(query, end, lists_[query - run]);
      if (covered_ == 0 && query + 1 < end) return list_run(query + 1, end, run);
    }
  });
}

// Lists all points within some radius: more than the neighbours wanted, yet not too many. It lists nothing if
// no such radius is at hand.
void BlockSearch::list_candidates(LocalIndex query, LocalIndex last, CandidateList& list) {
  constexpr int kAttempts = 4;
  for (int attempt = 0; attempt < kAttempts && covered_ > 0; ++attempt) {
    const double radius = std::min(guess_, covered_);
    list_within(query, radius, 0, list);
    if (list.count > kMostCandidates) {
      guess_ = 0.6 * radius;
    } else if (list.count > neighbours_) {
      guess_ = radius * next_guess_[list.count];
      narrow(list);
      return;
    } else {
      guess_ = 1.4 * radius;
      if (guess_ > covered_) find_surroundings(query, last, kRunGuess * guess_);
    }
  }
  list.count = 0;
}

// Where density changes, a list holds many more candidates than are wanted: fewer are ranked in registers. On
// a surface, half of the squared radius holds half of the points.
void BlockSearch::narrow(CandidateList& list) {
  const double wanted = 1.2 * wanted_candidates(neighbours_);
  if (list.count <= kBatchesInRegisters || wanted > kBatchesInRegisters) return;
  const auto limit = static_cast<float>(list.limit * wanted / static_cast<double>(list.count));
  narrow_list(limit, neighbours_ + 1, list);
  set_distance_bound(list);
}

// The points within the radius, and those whose scaled squared distance exceeds it by at most `more`.
void BlockSearch::list_within(LocalIndex query, double radius, double more, CandidateList& list) {
  float at[3];
  for (int axis = 0; axis < 3; ++axis)
    at[axis] =
        static_cast<float>((positions_[query][axis] - surroundings_.origin[axis]) * surroundings_.scale);
  const double scaled = radius * surroundings_.scale;
  const auto limit = static_cast<float>(scaled * scaled + more);
  find_within(surroundings_, at, limit, list);
  set_distance_bound(list);
}

void BlockSearch::set_distance_bound(CandidateList& list) const {
  list.squared_distance_bound =
      (list.limit - surroundings_.margin) / (surroundings_.scale * surroundings_.scale);
}

// Finds the neighbours of the queries of a run, whose candidates are listed.
void BlockSearch::rank(LocalIndex first, LocalIndex last, Lists lists) {
  // Ranks hold the query itself, its neighbours, and the next candidate, which must not be as near as the
  // last neighbour.
  const std::size_t wanted = neighbours_ + 2;
  const bool can_rank = wanted <= kMostCandidates;
  if (can_rank) rank_lists(last - first, wanted, true);
  for (LocalIndex query = first; query < last; ++query) {
    const std::size_t place = query - first;
    const CandidateList& list = lists_[place];
    const Ranking& ranking = rankings_[place / kQueries];
    const std::span found(lists[place], neighbours_);
    if (!can_rank || list.count == 0 || ranking.is_ambiguous[place % kQueries]) {
      find_exactly(query, list, found);
    } else {
      ranking.pick(list, place % kQueries, found.size(), found.data());
    }
  }
}

void BlockSearch::rank_lists(std::size_t count, std::size_t wanted, bool ends_at_limit) {
  for (std::size_t place = 0; place < count; place += kQueries)
    rank_candidates(&lists_[place], std::min(kQueries, count - place), wanted, ends_at_limit,
                    rankings_[place / kQueries]);
}

// The exact fallback computes distances in double precision, of listed candidates or of a walk through the
// tree.
void BlockSearch::find_exactly(LocalIndex query, const CandidateList& list, std::span<LocalIndex> found) {
  nearest_.clear();
  for (std::size_t i = 0; i < list.count; ++i) keep_if_near(query, list.points[i]);
  const bool are_listed = list.count > 0 && nearest_.front().squared_distance < list.squared_distance_bound;
  if (!are_listed) guess_ = kRunGuess * distance_to_last(query);
  std::sort_heap(nearest_.begin(), nearest_.end());
  refuse_underflow(nearest_[0].squared_distance, ids_[query], ids_[nearest_[0].index]);
  for (std::size_t rank = 0; rank < found.size(); ++rank) found[rank] = nearest_[rank].index;
}

// Finds the query's neighbours; returns how far the last one is.
double BlockSearch::distance_to_last(LocalIndex query) {
  nearest_.clear();
  const auto bound = [this] {
    return nearest_.size() == neighbours_ ? nearest_.front().squared_distance : kInfinite;
  };
  tree_.walk(positions_[query], bound, [&](std::size_t first, std::size_t last) {
    for (std::size_t q = first; q < last; ++q) keep_if_near(query, static_cast<LocalIndex>(q));
  });
  return std::sqrt(nearest_.front().squared_distance);
}

// Keeps the nearest ones, the farthest of them on top of a heap.
void BlockSearch::keep_if_near(LocalIndex query, LocalIndex other) {
  if (other == query) return;
  const Neighbour neighbour{squared_distance(positions_[query], positions_[other]), ids_[other], other};
  if (nearest_.size() == neighbours_) {
    if (!(neighbour < nearest_.front())) return;
    std::pop_heap(nearest_.begin(), nearest_.end());
    nearest_.pop_back();
  }
  nearest_.push_back(neighbour);
  std::push_heap(nearest_.begin(), nearest_.end());
}

// Lists and ranks the points within the radius of the queries of a run, and points that may be within it.
void BlockSearch::list_balls(LocalIndex first, LocalIndex last, double radius) {
  std::size_t most = 0;
  const auto same_radius = [radius] { return radius; };
  for_each_run(first, last, same_radius, [&](LocalIndex begin, LocalIndex end) {
    for (LocalIndex query = begin; query < end; ++query) {
      CandidateList& list = lists_[query - first];
      list.count = kMostCandidates + 1;
      if (covered_ > 0) list_within(query, radius, 2 * surroundings_.margin, list);
      if (list.count <= kMostCandidates) most = std::max(most, list.count);
    }
  });
  rank_lists(last - first, most, false);
}

void BlockSearch::collect_ball(LocalIndex query, std::size_t place, double squared_radius) {
  const CandidateList& list = lists_[place];
  const Ranking& ranking = rankings_[place / kQueries];
  const bool is_listed = list.count <= kMostCandidates;
  const auto may_be_outside = [&](std::size_t rank) {
    return list.squared_distances[ranking.number(rank, place % kQueries)] >= list.limit - 4 * list.margin;
  };
  found_.clear();
  if (is_listed && !ranking.is_ambiguous[place % kQueries] && !may_be_outside(list.count - 1)) {
    found_.resize(list.count - 1);
    ranking.pick(list, place % kQueries, found_.size(), found_.data());
    return;
  }
  nearest_.clear();
  if (is_listed) {
    for (std::size_t i = 0; i < list.count; ++i) collect_point(query, list.points[i], squared_radius);
  } else {
    const auto bound = [=] { return squared_radius; };
    tree_.walk(positions_[query], bound, [&](std::size_t first, std::size_t last) {
      for (std::size_t q = first; q < last; ++q)
        collect_point(query, static_cast<LocalIndex>(q), squared_radius);
    });
  }
  std::sort(nearest_.begin(), nearest_.end());
  for (const Neighbour& neighbour : nearest_) found_.push_back(neighbour.index);
}

void BlockSearch::collect_point(LocalIndex query, LocalIndex other, double squared_radius) {
  const double distance = squared_distance(positions_[query], positions_[other]);
  if (other != query && distance <= squared_radius) nearest_.push_back({distance, ids_[other], other});
}

// Finds all blocks within `radius` of any query of [first, last). Returns false, and no block, if there are
// too many or single precision does not suffice.
bool BlockSearch::find_surroundings(LocalIndex first, LocalIndex last, double radius) {
  covered_ = 0;
  surroundings_.count = 0;
  BlockBox run;
  for (LocalIndex q = first; q < last; ++q) run.extend(positions_[q]);
  const double squared_radius = radius * radius * kSlack;
  if (!(squared_radius > kLeastSquared && squared_radius < kMostSquared) || !set_origin(run, radius))
    return false;
  if (!tree_.find_near(run, squared_radius, surroundings_)) return false;
  tree_.fill_surroundings(surroundings_);
  covered_ = radius;
  return true;
}

// Sets origin, scale and margin of the surroundings. Returns false where single precision has too few digits.
bool BlockSearch::set_origin(const BlockBox& run, double radius) {
  surroundings_.scale = std::ldexp(1.0, -std::ilogb(radius));
  const double scaled = radius * surroundings_.scale;
  double extent = 0;  // of the run, from the origin, along an axis
  for (int axis = 0; axis < 3; ++axis) {
    surroundings_.origin[axis] = (run.low[axis] + run.high[axis]) / 2;
    extent = std::max({extent, (run.high[axis] - surroundings_.origin[axis]) * surroundings_.scale,
                       (surroundings_.origin[axis] - run.low[axis]) * surroundings_.scale});
  }
  // The rounding of single precision is u. A query is at most `extent` from the origin along each axis, and a
  // point is at distance d. Each difference of coordinates has an error of 2 u (extent + d). So the sum of
  // squares has an error of 4 u (sqrt(3) extent d + d^2). Squaring and adding add 3 u d^2. The sum is below 7
  // u d (extent + d).
  constexpr double kRounding = 0x1p-24;
  surroundings_.margin = 8 * kRounding * scaled * (extent + scaled);
  return extent <= kLargestRun * scaled;
}

void refuse_underflow(double squared_distance, PointId a, PointId b) {
  if (squared_distance >= std::numeric_limits<double>::min()) return;
  throw Error("points " + std::to_string(value(a)) + " and " + std::to_string(value(b)) +
              " differ by less than 1.5e-154: their squared distance underflows; scale the scan up");
}

}  // namespace lacuna
