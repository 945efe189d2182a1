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
// a radius guessed from the last ones. Distances are compared in vectors, and the neighbours ranked by
// counting how many are nearer. Where the guess holds too few, the query is looked up again within a bound;
// where that holds too many (the order jumps far), in a `PointTree`, built when it is first needed.
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
  double reach_of(LocalIndex query, std::size_t k);
  bool look_around(LocalIndex first, LocalIndex last, double radius);
  bool rank(LocalIndex query, double radius, std::size_t k);

  std::span<const Eigen::Vector3d> positions_;
  std::span<const PointId> ids_;
  std::vector<double> coordinates_;  // per block: 16 x, 16 y, 16 z; beyond the last point: infinite
  std::vector<Boxes> levels_;        // of blocks, of groups of eight, of groups of these, ...
  std::unique_ptr<Candidates> candidates_;
  std::vector<Neighbour> found_;
  double last_radius_ = 0;      // of the query before
  double guess_ = 0;            // of the last two; 0: none yet
  std::vector<double> beside_;  // working space
  std::optional<PointTree> tree_;
};

}  // namespace lacuna
