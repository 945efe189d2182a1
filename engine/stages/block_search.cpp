#include "engine/stages/block_search.hpp"

#include "engine/core/error.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace lacuna {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Blocks around a run of queries are looked for within this multiple of the radius for one.
constexpr double kRunGuess = 1.3;

// Bounds are widened by more than rounding can have narrowed them.
constexpr double kSlack = 1 + 1e-12;

// So many candidates that most likely all neighbours are among them: more take longer to rank, fewer fail
// more often.
double wanted_candidates(std::size_t neighbours) {
  const double found = static_cast<double>(neighbours) + 1;  // with the query itself
  return found + 1.2 * std::sqrt(found);
}

struct Box {
  std::array<double, 3> low{kInfinite, kInfinite, kInfinite};
  std::array<double, 3> high{-kInfinite, -kInfinite, -kInfinite};

  void extend(const Eigen::Vector3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
};

}  // namespace

// Boxes of one level, one array per side, padded to whole groups with empty boxes.
struct BlockSearch::Boxes {
  std::size_t count;
  std::array<std::vector<double>, 3> low, high;

  explicit Boxes(std::size_t count) : count(count) {
    const std::size_t padded = (count + kFan - 1) / kFan * kFan;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis].assign(padded, kInfinite);
      high[axis].assign(padded, -kInfinite);
    }
  }

  // Where the boxes of a group begin.
  struct Sides {
    const double *lows[3], *highs[3];
  };
  Sides sides(std::size_t group) const {
    Sides sides{};
    for (int axis = 0; axis < 3; ++axis) {
      sides.lows[axis] = low[axis].data() + group * kFan;
      sides.highs[axis] = high[axis].data() + group * kFan;
    }
    return sides;
  }

  // Squared distances from a box to those of a group.
  void gaps(std::size_t group, const double* from_low, const double* from_high, double* squared) const {
    const Sides to = sides(group);
    fastest::box_gaps(from_low, from_high, to.lows, to.highs, squared);
  }

  // A bit for each box of a group that is within the radius of a box.
  std::uint32_t within(std::size_t group, const Box& from, double squared_radius) const {
    const Sides to = sides(group);
    const std::size_t there =
        std::min(kFan, count - group * kFan);  // where distances overflow, so does padding
    return fastest::boxes_within(from.low.data(), from.high.data(), to.lows, to.highs, squared_radius) &
           ((1U << there) - 1);
  }
};

BlockSearch::BlockSearch(std::span<const Eigen::Vector3d> positions, std::span<const PointId> ids)
    : positions_(positions), ids_(ids) {
  const std::size_t blocks = (positions.size() + kBlock - 1) / kBlock;
  blocks_.resize(blocks);
  sight_.all = blocks_.data();
  levels_.emplace_back(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    Box box;
    const std::size_t end = std::min((b + 1) * kBlock, positions.size());
    if (end < (b + 1) * kBlock) std::fill_n(blocks_[b].coordinates[0], 3 * kBlock, kInfinite);
    for (std::size_t i = b * kBlock; i < end; ++i) {
      box.extend(positions[i]);
      for (int axis = 0; axis < 3; ++axis) {
        blocks_[b].coordinates[axis][i % kBlock] = positions[i][axis];
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      levels_[0].low[axis][b] = box.low[axis];
      levels_[0].high[axis][b] = box.high[axis];
    }
  }
  while (levels_.back().count > kFan) {
    const Boxes& below = levels_.back();
    const std::size_t count = (below.count + kFan - 1) / kFan;
    Boxes level(count);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto low = below.low[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        const auto high = below.high[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        level.low[axis][i] = *std::min_element(low, low + kFan);
        level.high[axis][i] = *std::max_element(high, high + kFan);
      }
    }
    levels_.push_back(std::move(level));
  }
}

BlockSearch::~BlockSearch() = default;

// Neighbours of the queries of one block, or of a part of it.
void BlockSearch::find(LocalIndex first, LocalIndex last, std::size_t k) {
  neighbours_ = std::min(k, positions_.size() - 1);
  found_.resize(kBlock * neighbours_);
  if (neighbours_ == 0) return;
  if (guess_ == 0) guess_ = distance_to_last(first);
  const bool together = look_around(first, last, kRunGuess * guess_);
  for (LocalIndex query = first; query < last; ++query) {
    if (!together) look_around(query, query + 1, kRunGuess * guess_);  // the order jumps within the run
    list_candidates(query, together ? last : query + 1, lists_[query - first]);
  }
  for (LocalIndex begin = first; begin < last; begin += kQueries)
    rank(begin, std::min<LocalIndex>(begin + kQueries, last), begin - first);
}

// All points within some radius: more than the neighbours wanted, yet not too many. None if there is no such
// radius at hand.
void BlockSearch::list_candidates(LocalIndex query, LocalIndex last, CandidateList& list) {
  constexpr int kAttempts = 4;
  for (int attempt = 0; attempt < kAttempts && in_sight_ > 0; ++attempt) {
    const double radius = std::min(guess_, in_sight_);
    // Never infinite: at infinity lies the padding beyond the last point.
    const double squared_radius = std::min(radius * radius * kSlack, std::numeric_limits<double>::max());
    fastest::find_within(sight_, positions_[query].data(), squared_radius, list);
    if (list.count > kMostCandidates) {
      guess_ = 0.6 * radius;
    } else if (list.count > neighbours_) {
      // On a surface, twice the radius holds four times the points.
      const double share = wanted_candidates(neighbours_) / static_cast<double>(list.count);
      guess_ = (guess_ + radius * std::sqrt(share)) / 2;
      return;
    } else {
      guess_ = 1.4 * radius;
      if (guess_ > in_sight_) look_around(query, last, kRunGuess * guess_);
    }
  }
  list.count = 0;
}

// Sorts the keys of eight lists or fewer, from `place` on, as far as the first `wanted` of each.
void BlockSearch::sort_lists(std::size_t place, std::size_t count, std::size_t wanted) {
  const std::span lists = std::span(lists_).subspan(place, count);
  std::size_t rows = wanted;
  for (const CandidateList& list : lists) rows = std::max(rows, list.count);
  bool* const tied = &tied_[place];
  std::fill_n(tied, count, true);
  if (rows > kMostSortedRows) return;
  std::vector<Eight>& keys = keys_[place / kQueries];
  if (keys.size() < rows) keys.resize(rows);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t row = 0;
    for (; row < lists[i].count; ++row) keys[row].at[i] = lists[i].keys[row];
    for (; row < rows; ++row) keys[row].at[i] = kInfinite;
  }
  fastest::sort_rows(keys.data(), rows, wanted);
  fastest::find_ties(keys.data(), wanted, tied);
}

// The neighbours of eight queries or fewer, whose candidates are listed from `place` on.
void BlockSearch::rank(LocalIndex first, LocalIndex last, std::size_t place) {
  // The query itself, its neighbours, and the one after them, which must not be as near as the last.
  sort_lists(place, last - first, neighbours_ + 2);
  for (LocalIndex query = first; query < last; ++query, ++place) {
    const CandidateList& list = lists_[place];
    const std::span found = std::span(found_).subspan(place * neighbours_, neighbours_);
    if (list.count == 0 || tied_[place]) {
      find_carefully(query, list, found);
    } else {
      for (std::size_t rank = 0; rank < found.size(); ++rank)
        found[rank] = list.point(keys_[place / kQueries][rank + 1].at[place % kQueries]);
    }
    refuse_underflow(squared_distance(positions_[query], positions_[found[0]]), ids_[query], ids_[found[0]]);
  }
}

// By the distances themselves, of listed candidates or of what a walk through the tree finds.
void BlockSearch::find_carefully(LocalIndex query, const CandidateList& list, std::span<LocalIndex> found) {
  if (list.count > 0) {
    nearest_.clear();
    for (std::size_t i = 0; i < list.count; ++i) meet(query, list.point(list.keys[i]));
  } else {
    guess_ = kRunGuess * distance_to_last(query);
  }
  std::sort_heap(nearest_.begin(), nearest_.end());
  for (std::size_t rank = 0; rank < found.size(); ++rank) found[rank] = nearest_[rank].index;
}

// Finds the query's neighbours, nearest blocks first; returns how far the last one is.
double BlockSearch::distance_to_last(LocalIndex query) {
  nearest_.clear();
  descend(query, levels_.size() - 1, 0);
  return std::sqrt(nearest_.front().squared_distance);
}

void BlockSearch::descend(LocalIndex query, std::size_t level, std::size_t group) {
  std::array<double, kFan> gaps;
  const double* const position = positions_[query].data();
  levels_[level].gaps(group, position, position, gaps.data());
  std::array<std::size_t, kFan> order;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gaps[a] < gaps[b]; });
  for (const std::size_t i : order) {
    if (group * kFan + i >= levels_[level].count) continue;
    const bool is_full = nearest_.size() == neighbours_;
    if (is_full && gaps[i] > nearest_.front().squared_distance) return;
    const std::size_t index = group * kFan + i;
    if (level > 0) {
      descend(query, level - 1, index);
    } else {
      const std::size_t end = std::min((index + 1) * kBlock, positions_.size());
      for (std::size_t q = index * kBlock; q < end; ++q) meet(query, static_cast<LocalIndex>(q));
    }
  }
}

// Keeps the nearest ones, the farthest of them on top of a heap.
void BlockSearch::meet(LocalIndex query, LocalIndex other) {
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

// Lists and sorts the points within the radius of queries of one block.
void BlockSearch::list_balls(LocalIndex first, LocalIndex last, double radius) {
  look_around(first, last, radius);
  for (LocalIndex query = first; query < last; ++query) {
    CandidateList& list = lists_[query - first];
    list.count = kMostCandidates + 1;
    if (in_sight_ > 0) fastest::find_within(sight_, positions_[query].data(), radius * radius, list);
  }
  for (LocalIndex begin = first; begin < last; begin += kQueries) {
    std::size_t rows = 0;
    const std::size_t count = std::min<std::size_t>(kQueries, last - begin);
    for (std::size_t i = 0; i < count; ++i) rows = std::max(rows, lists_[begin - first + i].count);
    sort_lists(begin - first, count, rows);
  }
}

void BlockSearch::collect_ball(LocalIndex query, std::size_t place, double squared_radius) {
  const CandidateList& list = lists_[place];
  found_.clear();
  if (!tied_[place]) {
    for (std::size_t rank = 1; rank < list.count; ++rank)
      found_.push_back(list.point(keys_[place / kQueries][rank].at[place % kQueries]));
    return;
  }
  nearest_.clear();
  collect(query, squared_radius, levels_.size() - 1, 0);
  std::sort(nearest_.begin(), nearest_.end());
  for (const Neighbour& neighbour : nearest_) found_.push_back(neighbour.index);
}

void BlockSearch::collect(LocalIndex query, double squared_radius, std::size_t level, std::size_t group) {
  std::array<double, kFan> gaps;
  const double* const position = positions_[query].data();
  levels_[level].gaps(group, position, position, gaps.data());
  const std::size_t first = group * kFan, last = std::min(first + kFan, levels_[level].count);
  for (std::size_t index = first; index < last; ++index) {
    if (gaps[index - first] > squared_radius) continue;
    if (level > 0) {
      collect(query, squared_radius, level - 1, index);
      continue;
    }
    const std::size_t end = std::min((index + 1) * kBlock, positions_.size());
    for (std::size_t q = index * kBlock; q < end; ++q) {
      const double distance = squared_distance(positions_[query], positions_[q]);
      if (q != query && distance <= squared_radius)
        nearest_.push_back({distance, ids_[q], static_cast<LocalIndex>(q)});
    }
  }
}

// Finds all blocks within `radius` of any query of [first, last). False, and none, if they are too many.
bool BlockSearch::look_around(LocalIndex first, LocalIndex last, double radius) {
  in_sight_ = 0;
  sight_.count = 0;
  Box run;
  for (LocalIndex q = first; q < last; ++q) run.extend(positions_[q]);
  const double squared_radius = radius * radius * kSlack;

  struct Place {
    std::size_t level, group;
  };
  std::array<Place, 128> stack;
  std::size_t depth = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  while (depth > 0) {
    const auto [level, group] = stack[--depth];
    const Boxes& boxes = levels_[level];
    for (std::uint32_t within = boxes.within(group, run, squared_radius); within != 0; within &= within - 1) {
      const std::size_t index = group * kFan + static_cast<std::size_t>(std::countr_zero(within));
      if (level > 0) {
        stack[depth++] = {level - 1, index};
        continue;
      }
      if (sight_.count == kMostBlocks) return false;
      for (int axis = 0; axis < 3; ++axis) {
        sight_.low[axis][sight_.count] = boxes.low[axis][index];
        sight_.high[axis][sight_.count] = boxes.high[axis][index];
      }
      sight_.blocks[sight_.count++] = static_cast<std::uint32_t>(index);
    }
  }
  in_sight_ = radius;
  return true;
}

void refuse_underflow(double squared_distance, PointId a, PointId b) {
  if (squared_distance >= std::numeric_limits<double>::min()) return;
  throw Error("points " + std::to_string(value(a)) + " and " + std::to_string(value(b)) +
              " differ by less than 1.5e-154: their squared distance underflows; scale the scan up");
}

}  // namespace lacuna
