// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/spanning.hpp"

#include "engine/stitch/union_find.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <queue>
#include <set>

#include <catch2/catch.hpp>

namespace lacuna::paper {
namespace {

using Edges = std::vector<std::pair<LocalIndex, LocalIndex>>;

Edges shuffled(Edges edges, Random& random) {
  for (std::size_t i = edges.size(); i > 1; --i) {
    std::swap(edges[i - 1], edges[static_cast<std::size_t>(random.whole(0, std::int64_t(i) - 1))]);
  }
  return edges;
}

constexpr std::uint64_t kInMemory = 1 << 20;
constexpr std::uint64_t kMapped = 0;

// The edges of the spanning graph, each once, lower end first; its rows are checked on the way.
Edges span(LocalIndex vertices, const Edges& edges, std::int64_t e, std::uint64_t budget = kInMemory) {
  const test::ScratchFolder folder;
  Scratch scratch(folder / "", budget);
  std::vector<PointId> ids;
  for (LocalIndex v = 0; v < vertices; ++v) ids.push_back(PointId{v});
  Spanning spanning(ids, e, scratch);
  for (const auto& [a, b] : edges) spanning.add({a, b});
  const SpanningGraph graph = spanning.finish();
  REQUIRE(graph.size() == vertices);
  Edges found;
  std::size_t ends = 0;
  for (LocalIndex v = 0; v < vertices; ++v) {
    CHECK(std::is_sorted(graph[v].begin(), graph[v].end()));
    ends += graph[v].size();
    for (const LocalIndex w : graph[v]) {
      if (v < w) found.emplace_back(v, w);
    }
  }
  CHECK(ends == 2 * found.size());
  return found;
}

// The rule of the method, edge by edge: a breadth-first search for every edge.
Edges span_plainly(LocalIndex vertices, const Edges& edges, std::int64_t e) {
  std::vector<std::vector<LocalIndex>> graph(vertices);
  const auto distance = [&](LocalIndex from, LocalIndex to) {  // -1: no path
    std::vector<std::int64_t> steps(vertices, -1);
    std::queue<LocalIndex> queue;
    steps[from] = 0;
    queue.push(from);
    for (; !queue.empty(); queue.pop()) {
      for (const LocalIndex w : graph[queue.front()]) {
        if (steps[w] >= 0) continue;
        steps[w] = steps[queue.front()] + 1;
        queue.push(w);
      }
    }
    return steps[to];
  };
  Edges taken;
  for (const auto& [a, b] : edges) {
    const std::int64_t d = distance(a, b);
    if (d >= 0 && d + 1 <= e) continue;
    graph[a].push_back(b);
    graph[b].push_back(a);
    taken.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

const Edges kSquare = {{0, 1}, {1, 2}, {2, 3}, {0, 3}};

TEST_CASE("the fourth side of a square closes a loop of four edges: taken with e = 3, not with e = 4") {
  CHECK(span(4, kSquare, 3) == Edges{{0, 1}, {0, 3}, {1, 2}, {2, 3}});
  CHECK(span(4, kSquare, 4) == Edges{{0, 1}, {1, 2}, {2, 3}});
}

TEST_CASE("a ring of n is closed exactly when n > e") {
  for (const LocalIndex n : {3u, 14u, 15u, 16u, 101u}) {
    Edges ring;
    for (LocalIndex v = 0; v + 1 < n; ++v) ring.emplace_back(v, v + 1);
    ring.emplace_back(0, n - 1);
    CHECK(span(n, ring, n - 1).size() == n);
    CHECK(span(n, ring, n).size() == n - 1);
  }
}

TEST_CASE("vertices without edges have empty rows, and no vertices give an empty graph") {
  CHECK(span(5, {{1, 3}}, 14) == Edges{{1, 3}});
  CHECK(span(0, {}, 14).empty());
}

TEST_CASE("random graphs are spanned as by the plain rule, in memory and in mapped files") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const auto vertices = static_cast<LocalIndex>(random.whole(2, 120));
    const std::int64_t reach = random.whole(1, 12);
    std::set<std::pair<LocalIndex, LocalIndex>> drawn;
    for (int i = 0; i < 400; ++i) {
      const std::int64_t a = random.whole(0, vertices - 1);
      const std::int64_t b = random.chance(0.1)
                                 ? random.whole(0, vertices - 1)
                                 : std::min<std::int64_t>(a + random.whole(1, reach), vertices - 1);
      if (a != b) drawn.insert(std::minmax(static_cast<LocalIndex>(a), static_cast<LocalIndex>(b)));
    }
    const Edges edges = shuffled({drawn.begin(), drawn.end()}, random);
    const std::int64_t e = random.whole(1, 25);
    INFO("seed " << seed << ", e = " << e);
    const Edges expected = span_plainly(vertices, edges, e);
    CHECK(span(vertices, edges, e) == expected);
    if (seed % 10 == 0) CHECK(span(vertices, edges, e, kMapped) == expected);
  }
}

// The decisions on the edges that are known here, those of which one end is below `owned`.
std::vector<EdgeDecision> judge(LocalIndex vertices, LocalIndex owned, const Edges& edges, std::int64_t e) {
  const test::ScratchFolder folder;
  Scratch scratch(folder / "", kInMemory);
  std::vector<PointId> ids;
  std::vector<LocalIndex> open;
  for (LocalIndex v = 0; v < vertices; ++v) {
    ids.push_back(PointId{v});
    if (v >= owned) open.push_back(v);
  }
  Spanning spanning(ids, e, scratch, open);
  std::vector<EdgeDecision> verdicts;
  for (const auto& [a, b] : edges) {
    if (std::min(a, b) < owned) verdicts.push_back(spanning.add({a, b}));
  }
  return verdicts;
}

TEST_CASE("verdicts on a part of a random graph are those on the whole, whatever the rest is") {
  std::size_t decided = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const auto vertices = static_cast<LocalIndex>(random.whole(2, 120));
    const auto owned = static_cast<LocalIndex>(random.whole(1, vertices));
    const std::int64_t reach = random.whole(1, 6);
    std::set<std::pair<LocalIndex, LocalIndex>> drawn;
    for (int i = 0; i < 300; ++i) {
      const std::int64_t a = random.whole(0, vertices - 1);
      const std::int64_t b = std::min<std::int64_t>(a + random.whole(1, reach), vertices - 1);
      if (a != b) drawn.insert({static_cast<LocalIndex>(a), static_cast<LocalIndex>(b)});
    }
    const Edges edges = shuffled({drawn.begin(), drawn.end()}, random);
    const std::int64_t e = random.whole(1, 12);
    INFO("seed " << seed << ", e = " << e);
    const Edges taken = span_plainly(vertices, edges, e);
    const std::vector<EdgeDecision> verdicts = judge(vertices, owned, edges, e);
    auto verdict = verdicts.begin();
    for (const auto& edge : edges) {
      if (edge.first >= owned) continue;
      const bool is_taken = std::binary_search(taken.begin(), taken.end(), edge);
      if (*verdict != EdgeDecision::undecided) CHECK((*verdict == EdgeDecision::taken) == is_taken);
      decided += *verdict++ != EdgeDecision::undecided;
      ++all;
    }
  }
  CHECK(decided > all / 2);
  CHECK(decided < all);
}

TEST_CASE("the root of a set is its smallest element, whatever the order of unions") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    std::vector<LocalIndex> links(100), smallest(100);
    for (LocalIndex v = 0; v < 100; ++v) smallest[v] = v;
    UnionFind sets(links);
    for (int i = 0; i < 80; ++i) {
      const auto a = static_cast<LocalIndex>(random.whole(0, 99)),
                 b = static_cast<LocalIndex>(random.whole(0, 99));
      const LocalIndex low = std::min(smallest[a], smallest[b]), high = std::max(smallest[a], smallest[b]);
      CHECK(sets.unite(a, b) == (low != high));
      std::replace(smallest.begin(), smallest.end(), high, low);
    }
    for (LocalIndex v = 0; v < 100; ++v) CHECK(sets.find(v) == smallest[v]);
  }
}

}  // namespace
}  // namespace lacuna::paper
