// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/loops.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::paper {
namespace {

using Edges = std::vector<std::pair<LocalIndex, LocalIndex>>;
using Cycle = std::vector<LocalIndex>;

std::vector<std::vector<LocalIndex>> rows_of(LocalIndex vertices, const Edges& edges) {
  std::vector<std::vector<LocalIndex>> rows(vertices);
  for (const auto& [a, b] : edges) {
    rows[a].push_back(b);
    rows[b].push_back(a);
  }
  for (auto& row : rows) std::sort(row.begin(), row.end());
  return rows;
}

std::vector<Cycle> loops_of(LocalIndex vertices, const Edges& edges, std::uint64_t budget = 1 << 20) {
  std::vector<std::uint64_t> offsets{0};
  std::vector<LocalIndex> indices;
  for (const auto& row : rows_of(vertices, edges)) {
    indices.insert(indices.end(), row.begin(), row.end());
    offsets.push_back(indices.size());
  }
  const ScratchFolder folder;
  Scratch scratch(folder / "", budget);
  std::vector<Cycle> loops;
  std::vector<PointId> ids;
  for (LocalIndex v = 0; v < vertices; ++v) ids.push_back(PointId{v});
  find_loops(keep_cycles({ids, offsets, indices}, scratch), scratch,
             [&](std::span<const LocalIndex> loop) { loops.emplace_back(loop.begin(), loop.end()); });
  return loops;
}

// Section 6 word for word; nothing is left out of the graph beforehand.
std::vector<Cycle> loops_plainly(LocalIndex vertices, const Edges& edges) {
  const auto rows = rows_of(vertices, edges);
  std::vector<Cycle> loops;
  std::set<LocalIndex> on_loop;
  for (LocalIndex origin = 0; origin < vertices; ++origin) {
    if (on_loop.count(origin)) continue;
    std::map<LocalIndex, LocalIndex> parent, branch;
    std::queue<LocalIndex> queue;
    for (const LocalIndex v : rows[origin]) {
      parent[v] = origin;
      branch[v] = v;
      queue.push(v);
    }
    Cycle loop;
    for (; !queue.empty() && loop.empty(); queue.pop()) {
      const LocalIndex v = queue.front();
      for (const LocalIndex w : rows[v]) {
        if (w == origin) continue;
        if (!branch.count(w)) {
          parent[w] = v;
          branch[w] = branch[v];
          queue.push(w);
        } else if (branch[w] != branch[v]) {
          for (LocalIndex at = v; at != origin; at = parent[at]) loop.insert(loop.begin(), at);
          loop.insert(loop.begin(), origin);
          for (LocalIndex at = w; at != origin; at = parent[at]) loop.push_back(at);
          break;
        }
      }
    }
    if (loop.empty()) continue;
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    if (loop.back() < loop[1]) std::reverse(loop.begin() + 1, loop.end());
    on_loop.insert(loop.begin(), loop.end());
    loops.push_back(loop);
  }
  return loops;
}

TEST_CASE("loops of random graphs are those of a search that leaves nothing out") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const auto vertices = static_cast<LocalIndex>(random.whole(3, 80));
    std::set<std::pair<LocalIndex, LocalIndex>> drawn;
    const std::int64_t count = vertices * random.whole(5, 16) / 10;
    for (std::int64_t i = 0; i < count; ++i) {
      const auto a = static_cast<LocalIndex>(random.whole(0, vertices - 1));
      const auto b = static_cast<LocalIndex>(random.whole(0, vertices - 1));
      if (a != b) drawn.insert(std::minmax(a, b));
    }
    const Edges edges(drawn.begin(), drawn.end());
    INFO("seed " << seed);
    const std::vector<Cycle> expected = loops_plainly(vertices, edges);
    CHECK(loops_of(vertices, edges) == expected);
    if (seed % 30 == 0) CHECK(loops_of(vertices, edges, 0) == expected);
  }
}

TEST_CASE("a long path with a ring at its end is searched without recursion") {
  Edges edges;
  constexpr LocalIndex n = 300'000;
  for (LocalIndex v = 0; v + 1 < n; ++v) edges.emplace_back(v, v + 1);
  edges.emplace_back(n - 20, n - 1);
  const std::vector<Cycle> loops = loops_of(n, edges);
  REQUIRE(loops.size() == 1);
  CHECK(loops[0].size() == 20);
}

}  // namespace
}  // namespace lacuna::paper
