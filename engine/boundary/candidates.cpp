// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/candidates.hpp"

#include "engine/boundary/rounds.hpp"

#include <mutex>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {

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

namespace {

// By row from the first candidate's on: the candidates that have it as a gap neighbour.
class Dependents {
 public:
  explicit Dependents(std::span<const Candidate> candidates)
      : first_(value(candidates.front().row)),
        begins_(value(candidates.back().row) - first_ + 2),
        candidates_(2 * candidates.size()) {
    for_each_gap(candidates, [&](std::size_t row, std::uint32_t) { ++begins_[row + 1]; });
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    std::vector<std::uint32_t> ends(begins_.begin(), begins_.end() - 1);
    for_each_gap(candidates, [&](std::size_t row, std::uint32_t i) { candidates_[ends[row]++] = i; });
  }

  std::span<const std::uint32_t> operator[](Row row) const {
    const std::size_t at = value(row) - first_;
    return std::span(candidates_).subspan(begins_[at], begins_[at + 1] - begins_[at]);
  }

 private:
  // Calls visit(row, candidate) for gap neighbours that lie among the candidates' rows.
  template <class Visit>
  void for_each_gap(std::span<const Candidate> candidates, Visit&& visit) const {
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
      for (const Row gap : {candidates[i].gap_near, candidates[i].gap_far}) {
        const std::uint64_t row = value(gap) - first_;  // large where it lies before the first
        if (row < begins_.size() - 1) visit(row, i);
      }
    }
  }

  std::uint64_t first_;
  std::vector<std::uint32_t> begins_;
  std::vector<std::uint32_t> candidates_;
};

// Takes candidates off the boundary until each remaining one has both of its gap neighbours on it.
// `candidates` in ascending row; only their own bits are changed. True if any was taken off. Repeated over
// parts of a scan, in any order, until no part changes, this gives the greatest fixed point of the whole.
// Cost: linear in the candidates and the rows between the first and the last of them.
bool remove_incoherent(std::span<const Candidate> candidates, RowSet& boundary) {
  std::vector<std::uint32_t> removed;
  const auto check = [&](std::uint32_t i) {
    const Candidate& c = candidates[i];
    if (!boundary.contains(c.row)) return;
    if (boundary.contains(c.gap_near) && boundary.contains(c.gap_far)) return;
    boundary.erase(c.row);
    removed.push_back(i);
  };
  for (std::uint32_t i = 0; i < candidates.size(); ++i) check(i);
  if (removed.empty()) return false;
  const Dependents dependents(candidates);
  while (!removed.empty()) {
    const Row row = candidates[removed.back()].row;
    removed.pop_back();
    for (const std::uint32_t i : dependents[row]) check(i);
  }
  return true;
}

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
