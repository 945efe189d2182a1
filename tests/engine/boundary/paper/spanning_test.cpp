// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/spanning.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::paper {
namespace {

using Edges = std::vector<std::pair<LocalIndex, LocalIndex>>;

Edges shuffled(Edges edges, Random& random) {
  for (std::size_t i = edges.size(); i > 1; --i)
    std::swap(edges[i - 1], edges[static_cast<std::size_t>(random.whole(0, std::int64_t(i) - 1))]);
  return edges;
}

constexpr std::uint64_t kInMemory = 1 << 20;
constexpr std::uint64_t kMapped = 0;

// The edges of the spanning graph, each once, lower end first; its rows are checked on the way.
Edges span(LocalIndex vertices, const Edges& edges, std::int64_t e, std::uint64_t budget = kInMemory) {
  const ScratchFolder folder;
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
    for (const LocalIndex w : graph[v])
      if (v < w) found.emplace_back(v, w);
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

}  // namespace
}  // namespace lacuna::paper
