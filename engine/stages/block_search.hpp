// block_search: the k nearest neighbours of points that stand in store order, sixteen at a time.
#pragma once

#include "engine/data/neighbourhoods.hpp"
#include "engine/stages/search.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lacuna {

// Points near in the order are near in space, so blocks of sixteen consecutive ones are the leaves of a
// tree that needs no building beyond its boxes. One walk finds the blocks around a block of queries, within
// a radius that holds k neighbours of each: that of the query before, plus the step from it. Distances are
// compared in vectors, and the neighbours ranked by counting how many are nearer. Where the order jumps the
// query is handed to `PointTree`, built when it is first needed.
//
// Exact: bounds err on the far side only, and every distance is computed as the method says.
// Cost: 16 points a block; memory: 32 bytes a point.
class BlockSearch {
 public:
  // Over distinct points, which must outlive it.
  BlockSearch(std::span<const Eigen::Vector3d> positions, std::span<const PointId> ids);
  ~BlockSearch();

  // For each query of [first, last), in order: visit(query, neighbours) with the first k in neighbour order,
  // all where fewer exist. Not from several threads at once. Throws `Error` if a squared distance
  // underflows.
  template <class Visit>
  void nearest(LocalIndex first, LocalIndex last, std::size_t k, Visit&& visit) {
    for (LocalIndex query = first; query < last; ++query) {
      find(query, last, k);
      visit(query, std::span<const Neighbour>(found_));
    }
  }

 private:
  struct Boxes;
  struct Candidates;
  void find(LocalIndex query, LocalIndex last, std::size_t k);
  double reach_of(LocalIndex query, std::size_t k) const;
  bool look_around(LocalIndex first, LocalIndex last, double reach);
  void rank_candidates(LocalIndex query, double radius, std::size_t k);

  std::span<const Eigen::Vector3d> positions_;
  std::span<const PointId> ids_;
  std::vector<double> coordinates_;  // per block: 16 x, 16 y, 16 z; beyond the last point: infinite
  std::vector<Boxes> levels_;        // of blocks, of groups of eight, of groups of these, ...
  std::unique_ptr<Candidates> candidates_;
  std::vector<Neighbour> found_;
  // The query before, whose k-th neighbour bounds the next one's.
  std::optional<LocalIndex> previous_;
  double previous_radius_ = 0;
  std::optional<PointTree> tree_;
};

}  // namespace lacuna
