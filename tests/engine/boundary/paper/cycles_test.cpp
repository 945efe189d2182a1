// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/cycles.hpp"

#include "engine/boundary/paper/loops.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

namespace lacuna::paper {
namespace {

using Edge = std::pair<LocalIndex, LocalIndex>;
using Edges = std::vector<Edge>;
using Vertices = std::vector<LocalIndex>;
using Cycle = std::vector<LocalIndex>;

struct Split {
  Edges complete;
  Vertices leads_out;
  std::vector<Cycle> loops;  // of the complete cycles
};

// Spans what it is given with e = 2, which takes every edge.
Split split(LocalIndex vertices, const Edges& edges, const Vertices& open) {
  const test::ScratchFolder folder;
  Scratch scratch(folder / "", 1 << 20);
  std::vector<PointId> ids;
  for (LocalIndex v = 0; v < vertices; ++v) ids.push_back(PointId{v});
  Spanning spanning(ids, 2, scratch);
  for (const auto& [a, b] : edges) spanning.add({a, b});
  const PartCycles cycles = split_cycles(spanning.finish(), open, scratch);
  Split found;
  for (LocalIndex v = 0; v < vertices; ++v) {
    if (cycles.leads_out[v]) found.leads_out.push_back(v);
    for (const LocalIndex w : cycles.complete[v]) {
      if (v < w) found.complete.emplace_back(v, w);
    }
  }
  find_loops(cycles.complete, scratch,
             [&](std::span<const LocalIndex> loop) { found.loops.emplace_back(loop.begin(), loop.end()); });
  return found;
}

TEST_CASE("an open vertex leads out even without an edge, and an empty graph is split") {
  CHECK(split(3, {{1, 2}}, {0}).leads_out == Vertices{0});
  CHECK(split(0, {}, {}).leads_out.empty());
}

// The vertices from `owned` on are elsewhere; so are all edges between these.
TEST_CASE("complete loops of a part and those of what leads out are the loops of the whole") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const auto vertices = static_cast<LocalIndex>(random.whole(4, 40));
    const auto owned = static_cast<LocalIndex>(random.whole(1, vertices));
    std::vector<LocalIndex> place(vertices);  // so that ids say nothing about where a vertex is
    for (LocalIndex v = 0; v < vertices; ++v) place[v] = v;
    for (LocalIndex v = vertices; v > 1; --v)
      std::swap(place[v - 1], place[static_cast<std::size_t>(random.whole(0, v - 1))]);
    std::set<Edge> drawn;
    for (int i = 0; i < random.whole(0, vertices * 3 / 2); ++i) {
      const auto a = static_cast<LocalIndex>(random.whole(0, vertices - 1));
      const auto b = static_cast<LocalIndex>(std::min<std::int64_t>(a + random.whole(1, 4), vertices - 1));
      if (a != b) drawn.insert(std::minmax(place[a], place[b]));
    }
    std::vector<bool> is_here(vertices);
    for (LocalIndex v = 0; v < owned; ++v) is_here[place[v]] = true;
    Edges known, unknown;
    std::set<LocalIndex> open;
    for (const Edge& edge : drawn) {
      const auto [a, b] = edge;
      (is_here[a] || is_here[b] ? known : unknown).push_back(edge);
      if (!is_here[a] && is_here[b]) open.insert(a);
      if (!is_here[b] && is_here[a]) open.insert(b);
    }
    INFO("seed " << seed);
    const Split part = split(vertices, known, {open.begin(), open.end()});
    Edges passed_on = unknown;
    for (const Edge& edge : known) {
      const auto leads_out = [&](LocalIndex v) {
        return std::binary_search(part.leads_out.begin(), part.leads_out.end(), v);
      };
      if (leads_out(edge.first) && leads_out(edge.second)) passed_on.push_back(edge);
    }
    std::vector<Cycle> loops = part.loops;
    for (const Cycle& loop : split(vertices, passed_on, {}).loops) loops.push_back(loop);
    std::vector<Cycle> expected = split(vertices, {drawn.begin(), drawn.end()}, {}).loops;
    std::sort(loops.begin(), loops.end());
    std::sort(expected.begin(), expected.end());
    CHECK(loops == expected);
  }
}

}  // namespace
}  // namespace lacuna::paper
