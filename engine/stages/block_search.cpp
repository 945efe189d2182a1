#include "engine/stages/block_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
  return found + 2 * std::sqrt(found);
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
  std::array<std::vector<double>, 3> low, high;

  explicit Boxes(std::size_t count) {
    const std::size_t padded = (count + kFan - 1) / kFan * kFan;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis].assign(padded, kInfinite);
      high[axis].assign(padded, -kInfinite);
    }
  }
  std::size_t size() const { return low[0].size(); }
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
  while (levels_.back().size() > kFan) {
    const Boxes& below = levels_.back();
    const std::size_t count = below.size() / kFan;
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
  if (guess_ == 0) {  // the order may jump at any of them, hardly at all
    guess_ = kInfinite;
    for (LocalIndex query = first; query < last; ++query) guess_ = std::min(guess_, reach_of(query));
  }
  look_around(first, last, kRunGuess * guess_);
  for (LocalIndex query = first; query < last; ++query) list_candidates(query, last, lists_[query - first]);
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

// The neighbours of eight queries or fewer, whose candidates are listed from `place` on.
void BlockSearch::rank(LocalIndex first, LocalIndex last, std::size_t place) {
  const std::span lists = std::span(lists_).subspan(place, last - first);
  // The query itself, its neighbours, and the one after them, which must not be as near as the last.
  const std::size_t wanted = neighbours_ + 2;
  std::size_t rows = wanted;
  for (const CandidateList& list : lists) rows = std::max(rows, list.count);
  std::array<bool, kQueries> tied{};
  tied.fill(rows > kMostSortedRows);
  if (rows <= kMostSortedRows) {
    if (keys_.size() < rows) keys_.resize(rows);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      std::size_t row = 0;
      for (; row < lists[i].count; ++row) keys_[row].at[i] = lists[i].keys[row];
      for (; row < rows; ++row) keys_[row].at[i] = kInfinite;
    }
    fastest::sort_keys(keys_.data(), sorting_network(rows, wanted), wanted, tied.data());
  }
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const LocalIndex query = first + static_cast<LocalIndex>(i);
    const std::span found = std::span(found_).subspan((place + i) * neighbours_, neighbours_);
    if (lists[i].count == 0 || tied[i]) {
      find_carefully(query, lists[i], found);
    } else {
      for (std::size_t rank = 0; rank < found.size(); ++rank)
        found[rank] = lists[i].point(keys_[rank + 1].at[i]);
    }
    refuse_underflow(squared_distance(positions_[query], positions_[found[0]]), ids_[query], ids_[found[0]]);
  }
}

// By the distances themselves, of listed candidates or of all points within a bound.
void BlockSearch::find_carefully(LocalIndex query, const CandidateList& list, std::span<LocalIndex> found) {
  careful_.clear();
  const auto add = [&](LocalIndex q) {
    if (q != query) careful_.push_back({squared_distance(positions_[query], positions_[q]), ids_[q], q});
  };
  if (list.count > 0) {
    for (std::size_t i = 0; i < list.count; ++i) add(list.point(list.keys[i]));
  } else if (look_around(query, query + 1, reach_of(query))) {
    for (std::size_t i = 0; i < sight_.count; ++i) {
      const std::size_t begin = sight_.blocks[i] * kBlock;
      for (std::size_t q = begin; q < std::min(begin + kBlock, positions_.size()); ++q)
        add(static_cast<LocalIndex>(q));
    }
  } else {
    if (!tree_) tree_.emplace(positions_, ids_);
    tree_->nearest(query, found.size(), careful_);
  }
  const auto end = careful_.begin() + static_cast<std::ptrdiff_t>(found.size());
  std::partial_sort(careful_.begin(), end, careful_.end());
  for (std::size_t rank = 0; rank < found.size(); ++rank) found[rank] = careful_[rank].index;
  if (list.count == 0) guess_ = std::sqrt(careful_[found.size() - 1].squared_distance) * kRunGuess;
}

// No less than the distance to the query's k-th neighbour.
double BlockSearch::reach_of(LocalIndex query) {
  const std::size_t k = neighbours_;
  if (positions_.size() <= k + 1) return kInfinite;
  // Any k points will do; those beside the query in the order are near. The query itself is at 0.
  const std::size_t first = query > k ? query - k : 0;
  const std::size_t last = std::min<std::size_t>(query + k + 1, positions_.size());
  beside_.clear();
  for (std::size_t i = first; i < last; ++i)
    beside_.push_back(squared_distance(positions_[query], positions_[i]));
  const auto kth = beside_.begin() + static_cast<std::ptrdiff_t>(k);
  std::nth_element(beside_.begin(), kth, beside_.end());
  return std::sqrt(*kth) * kSlack;
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
    const double *low[3], *high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = boxes.low[axis].data() + group * kFan;
      high[axis] = boxes.high[axis].data() + group * kFan;
    }
    double gaps[kFan];
    fastest::box_gaps(run.low.data(), run.high.data(), low, high, gaps);
    for (std::size_t i = kFan; i-- > 0;) {
      if (!(gaps[i] <= squared_radius) || !(low[0][i] <= high[0][i])) continue;  // far, or empty
      if (level > 0) {
        stack[depth++] = {level - 1, group * kFan + i};
        continue;
      }
      if (sight_.count == kMostBlocks) return false;
      for (int axis = 0; axis < 3; ++axis) {
        sight_.low[axis][sight_.count] = low[axis][i];
        sight_.high[axis][sight_.count] = high[axis][i];
      }
      sight_.blocks[sight_.count++] = static_cast<std::uint32_t>(group * kFan + i);
    }
  }
  in_sight_ = radius;
  return true;
}

}  // namespace lacuna
