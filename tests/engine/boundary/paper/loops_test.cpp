// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/loops.hpp"

#include "engine/boundary/paper/cycles.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <map>
#include <queue>
#include <set>

#include <catch2/catch.hpp>

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
  const test::ScratchFolder folder;
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

TEST_CASE("a ring is one loop, from its smallest vertex towards that one's smaller neighbour") {
  CHECK(loops_of(5, {{0, 3}, {3, 1}, {1, 4}, {4, 2}, {2, 0}}) == std::vector<Cycle>{{0, 2, 4, 1, 3}});
}

TEST_CASE("trees and bridges have no loop") {
  CHECK(loops_of(6, {{0, 1}, {1, 2}, {1, 3}, {3, 4}, {3, 5}}).empty());
  CHECK(loops_of(3, {}).empty());
  CHECK(loops_of(0, {}).empty());
}

TEST_CASE("a theta graph gives the short way round first, then the loop through what is left") {
  // 0 and 1 joined by paths of 1, 2 and 3 inner vertices.
  const Edges edges = {{0, 2}, {2, 1}, {0, 3}, {3, 4}, {4, 1}, {0, 5}, {5, 6}, {6, 7}, {7, 1}};
  CHECK(loops_of(8, edges) == std::vector<Cycle>{{0, 2, 1, 4, 3}, {0, 2, 1, 7, 6, 5}});
}

TEST_CASE("a small loop next to a long outer curve does not hide that one") {
  // A ring of 20 with a handle at its far side; the paper's first grey vertex would be in the handle.
  Edges edges;
  for (LocalIndex v = 0; v < 20; ++v) edges.emplace_back(v, (v + 1) % 20);
  edges.emplace_back(3, 20);
  edges.emplace_back(20, 4);
  const std::vector<Cycle> loops = loops_of(21, edges);
  REQUIRE(loops.size() == 2);
  CHECK(loops[0].size() == 20);
  CHECK(loops[1] == Cycle{3, 4, 20});
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
