// Results of every point of the input, for points.ply.
#pragma once

#include "engine/criteria/criterion.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <vector>

namespace lacuna {

// Of one point of the input.
struct StoredResult {
  PointId id;
  Row row;  // of the distinct point
  float probability;
  float criteria[kCriteria];
  float normal[3];
};

// Ids per block of results.
inline constexpr std::uint64_t kResultBlock = 1 << 17;

// By block of ids. Duplicates have the results of the point that stands for them.
class PointResults final : public TileConsumer {
 public:
  // `ids`: points of the input.
  PointResults(std::uint64_t ids, const TileStore& store, const Job& job);

  void take(const EvaluatedTile& tile) override;

  std::size_t blocks() const { return lists_.lists(); }
  // visit(result), in any order.
  template <class Visit>
  void for_each(std::size_t block, Visit&& visit) const {
    lists_.for_each(block, visit);
  }

 private:
  void append(std::vector<StoredResult>& results);  // and clears them

  const TileStore& store_;
  AppendLists<StoredResult> lists_;
};

}  // namespace lacuna
