// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/candidates.hpp"

#include "engine/boundary/rounds.hpp"

#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

// Returns the other tiles with gap neighbours of a tile's candidates, ascending.
std::vector<TileIndex> tiles_around(std::span<const Candidate> candidates, TileIndex tile,
                                    const Tiling& tiling) {
  std::vector<Row> foreign;
  for (const Candidate& c : candidates) {
    for (const Row gap : {c.gap_near, c.gap_far}) {
      if (!tiling.tiles[tile].owns(gap)) foreign.push_back(gap);
    }
  }
  return tiling.tiles_of(foreign);
}

}  // namespace

void emit_candidates(const EvaluatedTile& tile, TileOutput& output) {
  std::vector<Candidate> candidates;
  std::vector<CandidatePoint> points;
  for (const LocalIndex p : tile.candidates) {
    const Evaluation& e = tile.evaluations[p];
    if (e.gap_near == kNoIndex) continue;
    const std::vector<Row>& rows = tile.points.rows;
    candidates.push_back({rows[p], rows[e.gap_near], rows[e.gap_far]});
    points.push_back({tile.point(p), tile.probability(p)});
  }
  output.add(kCandidates, std::move(candidates));
  output.add(kCandidatePoints, std::move(points));
}

RowSet coherent_candidates(const TileOutputs& outputs, const Tiling& tiling, const TaskArena& arena,
                           Phases& phases) {
  const std::size_t tiles = tiling.tiles.size();
  Phase phase(phases, "coherence", tiling.points());
  RowSet boundary(tiling.row_count());
  std::vector<std::vector<TileIndex>> dependents(tiles);  // of each tile: the tiles that depend on its
                                                          // candidates
  std::mutex mutex;
  arena.for_each(tiles, [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    const std::vector<Candidate> candidates = outputs.read(kCandidates, t);
    for (const Candidate& c : candidates) boundary.insert(c.row);
    const std::vector<TileIndex> around = tiles_around(candidates, t, tiling);
    const std::lock_guard lock(mutex);
    for (const TileIndex other : around) dependents[other].push_back(t);
    phase.advance(tiling.tiles[t].points);
  });
  for (Rounds rounds(tiles); !rounds.tiles().empty(); rounds.next()) {
    arena.for_each(rounds.tiles().size(), [&](std::size_t i) {
      const TileIndex t = rounds.tiles()[i];
      if (remove_incoherent(outputs.read(kCandidates, t), boundary)) rounds.request(dependents[t]);
    });
  }
  return boundary;
}

RowSet candidates_between(const RowSet& on_loop, const TileOutputs& outputs, const Tiling& tiling,
                          const TaskArena& arena) {
  RowSet between(tiling.row_count());
  arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
    for (const Candidate& c : outputs.read(kCandidates, static_cast<TileIndex>(t))) {
      if (on_loop.contains(c.gap_near) && on_loop.contains(c.gap_far)) between.insert(c.row);
    }
  });
  return between;
}

}  // namespace lacuna
