#include "engine/passes/coherence.hpp"

#include "engine/passes/rounds.hpp"

namespace lacuna {
namespace {

std::vector<Candidate> read_candidates(const EvaluatedScan& scan, TileIndex tile) {
  std::vector<Candidate> candidates;
  for (const StoredCandidate& c : scan.candidates.read(tile)) candidates.push_back(c.candidate);
  return candidates;
}

}  // namespace

RowSet make_coherent(const EvaluatedScan& scan, const TileStore& store, Job& job) {
  const std::size_t tiles = store.tiling().tiles.size();
  Phase phase(job, "coherence", scan.totals.candidates);
  RowSet boundary(store.tiling().row_count());
  job.crew.for_each(tiles, [&](std::size_t t) {
    for (const Candidate& c : read_candidates(scan, static_cast<TileIndex>(t))) boundary.insert(c.row);
    phase.advance(scan.candidates.count(t));
  });

  for (Rounds rounds(tiles); !rounds.tiles().empty(); rounds.next()) {
    job.crew.for_each(rounds.tiles().size(), [&](std::size_t i) {
      const TileIndex tile = rounds.tiles()[i];
      if (settle_coherence(read_candidates(scan, tile), boundary)) rounds.ask_for(scan.leaning[tile]);
    });
  }
  return boundary;
}

RowSet find_beside_loops(const RawLoops& loops, const EvaluatedScan& scan, const TileStore& store, Job& job) {
  Phase phase(job, "coherence", scan.totals.candidates);
  RowSet on_loop(store.tiling().row_count()), beside(store.tiling().row_count());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (const Vertex& v : loops.read(i)) on_loop.insert(v.row);
  }
  job.crew.for_each(store.tiling().tiles.size(), [&](std::size_t t) {
    const std::vector<Candidate> candidates = read_candidates(scan, static_cast<TileIndex>(t));
    for (const Candidate& c : candidates) {
      if (on_loop.contains(c.gap_near) && on_loop.contains(c.gap_far)) beside.insert(c.row);
    }
    phase.advance(candidates.size());
  });
  return beside;
}

}  // namespace lacuna
