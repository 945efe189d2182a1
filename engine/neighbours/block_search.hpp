// SPDX-License-Identifier: Apache-2.0
// block_search: finds the k nearest neighbours of points in store order, many at a time.
//
// Idea: points near in the store order are near in space. So the leaves of a tree are blocks of sixteen
// consecutive points, and it needs no building beyond its boxes. One walk finds the blocks around a run of
// queries. Each query takes the points within a radius. It guesses the radius from the number of points that
// the query before found. Sixteen queries are ranked side by side, in single precision, relative to the run.
//
// Few queries are ambiguous: the radius holds too few points or too many, or two distances are too near to
// each other. Distances in double precision decide these, one query at a time.
//
// Source: Lacuna's own. Cost: the blocks around each run. Memory: 28 bytes a point.
#pragma once

#include "engine/model/neighbourhoods.hpp"
#include "engine/neighbours/candidate_list.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// ---- The tree over blocks of points in store order

// Empty: its low side is infinite.
struct BlockBox {
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{kInfinite, kInfinite, kInfinite};
  std::array<double, 3> high{-kInfinite, -kInfinite, -kInfinite};

  void extend(const Eigen::Vector3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
};

class BlockTree {
 public:
  BlockTree(const BlockTree&) = delete;
  BlockTree& operator=(const BlockTree&) = delete;
  explicit BlockTree(std::span<const Eigen::Vector3d> positions);

  // Sets `surroundings.blocks` to all blocks within the radius of a box. Returns false where they are more
  // than kMostBlocks.
  bool find_near(const BlockBox& box, double squared_radius, Surroundings& surroundings) const;

  // Fills the boxes and coordinates of the blocks in `surroundings.blocks`.
  void fill_surroundings(Surroundings& surroundings) const;

  // Calls visit(first, last) for the points of each block whose squared distance is at most bound(), mostly
  // the nearest block first. The bound may shrink on the way.
  template <class Bound, class Visit>
  void walk(const Eigen::Vector3d& from, Bound&& bound, Visit&& visit) const {
    walk(from, levels_.size() - 1, 0, bound, visit);
  }

 private:
  // Boxes of one level, one array per side, padded to whole groups with empty boxes.
  struct Level {
    std::size_t count;
    std::array<std::vector<double>, 3> low, high;

    explicit Level(std::size_t count);
    void set(std::size_t index, const BlockBox& box);
  };

  template <class Bound, class Visit>
  void walk(const Eigen::Vector3d& from, std::size_t level, std::size_t group, Bound& bound,
            Visit& visit) const {
    std::array<double, kFan> gaps;
    box_gaps(from.data(), from.data(), sides_[level], group, gaps.data());
    std::array<std::size_t, kFan> order;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gaps[a] < gaps[b]; });
    for (const std::size_t i : order) {
      const std::size_t index = group * kFan + i;
      if (index >= levels_[level].count) continue;
      if (gaps[i] > bound()) return;
      if (level > 0) {
        walk(from, level - 1, index, bound, visit);
      } else {
        visit(index * kBlock, std::min((index + 1) * kBlock, points_));
      }
    }
  }

  std::size_t points_;
  std::vector<Block> blocks_;
  std::vector<Level> levels_;
  std::vector<LevelSides> sides_;  // of the levels: places in their memory
};

// ---- The search

// Exact: bounds err on the far side only, and no rank is left to rounding.
class BlockSearch {
 public:
  // Searches among distinct points, which must outlive the search.
  BlockSearch(std::span<const Eigen::Vector3d> positions, std::span<const PointId> ids);

  // Calls visit(query, neighbours) for each query of [first, last), in order, with the first k in neighbour
  // order. It visits all neighbours where fewer than k exist. Not from several threads at once. Throws
  // `Error` if a squared distance underflows.
  template <class Visit>
  void nearest(LocalIndex first, LocalIndex last, std::size_t k, Visit&& visit) {
    const std::size_t count = neighbours_of(k);
    found_.resize(kRun * count);
    for (LocalIndex begin = first, end; begin < last; begin = end) {
      end = std::min<LocalIndex>(last, (begin / kRun + 1) * kRun);
      find(begin, end, k, {found_.data(), count});
      for (LocalIndex query = begin; query < end; ++query)
        visit(query, std::span<const LocalIndex>(found_).subspan((query - begin) * count, count));
    }
  }

  // Lists that begin at this distance from each other.
  struct Lists {
    LocalIndex* first;
    std::size_t stride;

    LocalIndex* operator[](std::size_t list) const { return first + list * stride; }
  };
  void nearest(LocalIndex first, LocalIndex last, std::size_t k, Lists lists);

  // Returns how many neighbours each query has.
  std::size_t neighbours_of(std::size_t k) const { return std::min(k, positions_.size() - 1); }

  // Calls visit(query, points) for each query of [first, last), in order. `points` are all other points whose
  // squared distance is at most radius * radius, in neighbour order.
  template <class Visit>
  void within(LocalIndex first, LocalIndex last, double radius, Visit&& visit) {
    for (LocalIndex begin = first, end; begin < last; begin = end) {
      end = std::min<LocalIndex>(last, (begin / kRun + 1) * kRun);
      list_balls(begin, end, radius);
      for (LocalIndex query = begin; query < end; ++query) {
        collect_ball(query, query - begin, radius * radius);
        visit(query, std::span<const LocalIndex>(found_));
      }
    }
  }

 private:
  static constexpr std::size_t kRun = 2 * kQueries;  // queries that share surroundings
  void find(LocalIndex first, LocalIndex last, std::size_t k, Lists lists);
  void prepare(std::size_t neighbours);
  void list_run(LocalIndex first, LocalIndex last, LocalIndex run);
  void list_candidates(LocalIndex query, LocalIndex last, CandidateList& list);
  void narrow(CandidateList& list);
  void set_distance_bound(CandidateList& list) const;
  void list_within(LocalIndex query, double radius, double more, CandidateList& list);
  void rank(LocalIndex first, LocalIndex last, Lists lists);
  void rank_lists(std::size_t count, std::size_t wanted, bool ends_at_limit);
  void find_exactly(LocalIndex query, const CandidateList& list, std::span<LocalIndex> found);
  double distance_to_last(LocalIndex query);
  void keep_if_near(LocalIndex query, LocalIndex other);
  void list_balls(LocalIndex first, LocalIndex last, double radius);
  void collect_ball(LocalIndex query, std::size_t place, double squared_radius);
  void collect_point(LocalIndex query, LocalIndex other, double squared_radius);
  template <class Radius, class Visit>
  void for_each_run(LocalIndex first, LocalIndex last, Radius&& radius, Visit&& visit);
  bool find_surroundings(LocalIndex first, LocalIndex last, double radius);
  bool set_origin(const BlockBox& run, double radius);

  std::span<const Eigen::Vector3d> positions_;
  std::span<const PointId> ids_;
  BlockTree tree_;

  double guess_ = 0;    // radius for the next query; 0: not known yet
  double covered_ = 0;  // `surroundings_` holds all blocks within this distance of the queries; 0: no block
  Surroundings surroundings_;
  std::array<CandidateList, kRun> lists_;  // of the queries of a run
  std::array<Ranking, kRun / kQueries> rankings_;
  std::size_t neighbours_ = 0;  // of each query
  // By the number of points that the query before found, in units of its radius.
  std::array<double, kMostCandidates + 1> next_guess_{};
  std::vector<LocalIndex> found_;   // by query of the run, or in one ball
  std::vector<Neighbour> nearest_;  // of one query, by the exact fallback
};

// Throws `Error` where two distinct points are so near that their squared distance loses digits.
void refuse_underflow(double squared_distance, PointId a, PointId b);

}  // namespace lacuna
