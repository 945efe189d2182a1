// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/candidates.hpp"

#include "engine/run/rounds.hpp"

#include <algorithm>
#include <utility>

namespace lacuna {
namespace {

std::vector<Candidate> without_points(std::span<const StoredCandidate> stored) {
  std::vector<Candidate> candidates;
  candidates.reserve(stored.size());
  for (const StoredCandidate& c : stored) candidates.push_back(c.candidate);
  return candidates;
}

}  // namespace

Candidates::Candidates(const TileStore& store, const Job& job)
    : tiling_(store.tiling()),
      lists_(job.file("candidates"), tiling_.tiles.size(), job.memory.spills / 12),
      dependents_(tiling_.tiles.size()) {}

void Candidates::emit(const EvaluatedTile& tile, TileOutput& output) const {
  std::vector<StoredCandidate> candidates;
  for (const LocalIndex p : tile.candidates) {
    const Evaluation& e = tile.evaluations[p];
    if (e.gap_near == kNoIndex) continue;
    const std::vector<Row>& rows = tile.points.rows;
    candidates.push_back({{rows[p], rows[e.gap_near], rows[e.gap_far]}, tile.stored(p), tile.probability(p)});
  }
  output.add("candidates", std::move(candidates));
}

void Candidates::absorb(TileIndex tile, const TileOutput& output) {
  add(tile, output.read<StoredCandidate>("candidates"));
}

void Candidates::add(TileIndex tile, std::span<const StoredCandidate> candidates) {
  lists_.append(tile, candidates);
  std::vector<Row> foreign;
  for (const StoredCandidate& c : candidates) {
    for (const Row gap : {c.candidate.gap_near, c.candidate.gap_far}) {
      if (!tiling_.tiles[tile].owns(gap)) foreign.push_back(gap);
    }
  }
  const std::lock_guard lock(mutex_);
  for (const TileIndex other : tiling_.tiles_of(foreign)) dependents_[other].push_back(tile);
}

RowSet Candidates::coherent(Job& job) const {
  const std::size_t tiles = tiling_.tiles.size();
  Phase phase(job, "coherence", tiling_.points());
  RowSet boundary(tiling_.row_count());
  job.arena.for_each(tiles, [&](std::size_t t) {
    for (const StoredCandidate& c : lists_.read(t)) boundary.insert(c.candidate.row);
    phase.advance(tiling_.tiles[t].points);
  });
  for (Rounds rounds(tiles); !rounds.tiles().empty(); rounds.next()) {
    job.arena.for_each(rounds.tiles().size(), [&](std::size_t i) {
      const TileIndex t = rounds.tiles()[i];
      if (remove_incoherent(without_points(lists_.read(t)), boundary)) rounds.request(dependents_[t]);
    });
  }
  return boundary;
}

RowSet Candidates::between(const RowSet& on_loop, Job& job) const {
  RowSet between(tiling_.row_count());
  job.arena.for_each(tiling_.tiles.size(), [&](std::size_t t) {
    for (const StoredCandidate& c : lists_.read(t)) {
      if (on_loop.contains(c.candidate.gap_near) && on_loop.contains(c.candidate.gap_far))
        between.insert(c.candidate.row);
    }
  });
  return between;
}

}  // namespace lacuna
