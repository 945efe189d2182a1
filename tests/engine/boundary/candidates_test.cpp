// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/candidates.hpp"

#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

std::vector<Row> all_rows(const TiledScan& scan) {
  std::vector<Row> rows;
  for (const auto& [id, row] : scan.rows()) rows.push_back(row);
  return rows;
}

// The candidates that are left, by taking off one at a time.
std::vector<Row> coherent_plainly(const std::vector<Candidate>& candidates, const std::vector<Row>& rows) {
  std::map<Row, bool> on;
  for (const Candidate& c : candidates) on[c.row] = true;
  for (bool changed = true; changed;) {
    changed = false;
    for (const Candidate& c : candidates) {
      if (!on[c.row] || (on[c.gap_near] && on[c.gap_far])) continue;
      on[c.row] = false;
      changed = true;
    }
  }
  std::vector<Row> left;
  for (const Row row : rows)
    if (on[row]) left.push_back(row);
  return left;
}

// As the evaluation leaves the candidates: by tile, in ascending row.
std::vector<Row> coherent(std::vector<Candidate> candidates, TiledScan& scan) {
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.row < b.row; });
  TileOutputs outputs(scan.store.tiling(), {}, {}, scan.job.spill);
  for (auto first = candidates.begin(); first != candidates.end();) {
    const TileIndex tile = scan.tile_of(first->row);
    std::vector<Candidate> of_tile;
    for (; first != candidates.end() && scan.tile_of(first->row) == tile; ++first) of_tile.push_back(*first);
    TileOutput output;
    output.add(kCandidates, of_tile);
    outputs.add(tile, output);
  }
  const RowSet boundary =
      coherent_candidates(outputs, scan.store.tiling(), scan.job.workers.arena, scan.job.phases);
  std::vector<Row> left;
  for (const Row row : all_rows(scan))
    if (boundary.contains(row)) left.push_back(row);
  return left;
}

TEST_CASE("candidates of many tiles that lean on each other at random settle as in one piece") {
  std::size_t taken = 0, left = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    TiledScan scan(plane(20).jittered(0.2, seed), tiled({}, std::int64_t(5 * seed), seed % 2 == 0 ? 8 : 2));
    const std::vector<Row> rows = all_rows(scan);
    Random random(seed);
    const auto near = [&](std::size_t i) {  // mostly: in this tile and the next ones
      const std::int64_t at = std::int64_t(i) + random.whole(-40, 40);
      return rows[std::size_t(std::clamp<std::int64_t>(at, 0, std::int64_t(rows.size()) - 1))];
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!random.chance(0.02))
        candidates.push_back({rows[i], near(i), random.chance(0.7) ? rows[i] : near(i)});
    }
    const std::vector<Row> expected = coherent_plainly(candidates, rows);
    INFO("seed " << seed);
    CHECK(coherent(candidates, scan) == expected);
    taken += candidates.size() - expected.size();
    left += expected.size();
  }
  CHECK(taken > 1000);
  CHECK(left > 1000);
}

}  // namespace
}  // namespace lacuna
