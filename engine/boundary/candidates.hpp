// SPDX-License-Identifier: Apache-2.0
// Candidates: points whose Pi exceeds the threshold (paper, 5.1), and which of them belong to the boundary.
#pragma once

#include "engine/boundary/coherence.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/point_column.hpp"
#include "engine/store/row_set.hpp"
#include "engine/store/tile_store.hpp"

#include <mutex>
#include <vector>

namespace lacuna {

struct StoredCandidate {
  Candidate candidate;
  StoredPoint point;
  float probability;
};
template <class Visit>
void for_each_row(StoredCandidate& record, Visit&& visit) {
  visit(record.candidate.row);
  visit(record.candidate.gap_near);
  visit(record.candidate.gap_far);
}

// The candidates that have gap neighbours, by tile in ascending row.
class Candidates final : public TileConsumer {
 public:
  Candidates(const TileStore& store, const Job& job);

  void emit(const EvaluatedTile& tile, TileOutput& output) const override;
  void absorb(TileIndex tile, const TileOutput& output) override;

  std::vector<StoredCandidate> read(TileIndex tile) const { return lists_.read(tile); }
  // Appends candidates of a tile, in ascending row. From any thread.
  void add(TileIndex tile, std::span<const StoredCandidate> candidates);

  // Those that are coherent: the greatest set of candidates of which each has both of its gap neighbours in
  // it. Tiles are evaluated on their own, and again while a tile that their candidates depend on changes; the
  // order does not matter. Memory: one bit per row.
  RowSet coherent(Job& job) const;
  // Those whose gap neighbours both lie on loops.
  RowSet between(const RowSet& on_loop, Job& job) const;

 private:
  const Tiling& tiling_;
  AppendLists<StoredCandidate> lists_;
  std::vector<std::vector<TileIndex>> dependents_;  // of each tile: those with candidates that depend on it
  std::mutex mutex_;
};

}  // namespace lacuna
