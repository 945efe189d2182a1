// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/loops.hpp"
#include "engine/boundary/paper/spanning.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::paper {
namespace {

using Loops = std::vector<std::vector<LocalIndex>>;  // by id

struct Whole {
  std::vector<PointId> ids;
  std::vector<WeightedEdge> edges;
};

void add_loops(const SpanningGraph& graph, Scratch& scratch, Loops& loops) {
  find_loops(graph, scratch, [&](std::span<const LocalIndex> found) {
    auto& loop = loops.emplace_back();
    for (const LocalIndex v : found) loop.push_back(static_cast<LocalIndex>(value(graph.ids[v])));
  });
}

Loops loops_of(const std::vector<PointId>& ids, std::vector<WeightedEdge> edges, std::int64_t e) {
  const ScratchFolder folder;
  Scratch scratch(folder / "", 1 << 20);
  order_edges(edges, ids);
  Spanning spanning(ids, e, scratch);
  for (const WeightedEdge& edge : edges) spanning.add({edge.a, edge.b});
  Loops loops;
  add_loops(spanning.finish(), scratch, loops);
  std::sort(loops.begin(), loops.end());
  return loops;
}

// Part by part, then what these pass on. part_of: of each vertex.
Loops loops_by_parts(const Whole& whole, const std::vector<int>& part_of, int parts, std::int64_t e,
                     std::size_t* passed_on = nullptr) {
  Loops loops;
  std::vector<PassedEdge> rest;
  for (int part = 0; part < parts; ++part) {
    std::vector<LocalIndex> vertices;  // owned ones first
    for (LocalIndex v = 0; v < whole.ids.size(); ++v)
      if (part_of[v] == part) vertices.push_back(v);
    const auto owned = static_cast<LocalIndex>(vertices.size());
    std::map<LocalIndex, LocalIndex> number;
    for (LocalIndex i = 0; i < owned; ++i) number[vertices[i]] = i;
    std::vector<WeightedEdge> edges;
    for (auto [a, b, weight] : whole.edges) {
      if (part_of[a] != part) std::swap(a, b);
      if (part_of[a] != part) continue;
      if (number.emplace(b, static_cast<LocalIndex>(vertices.size())).second) vertices.push_back(b);
      edges.push_back({number[a], number[b], weight});
    }
    std::vector<PointId> ids;
    for (const LocalIndex v : vertices) ids.push_back(whole.ids[v]);
    const ScratchFolder folder;
    Scratch scratch(folder / "", 1 << 20);
    const PartialSpanning spanned = span_partially({ids, owned}, edges, e, scratch);
    add_loops(spanned.complete, scratch, loops);
    for (const WeightedEdge& edge : spanned.taken)
      rest.push_back({vertices[edge.a], vertices[edge.b], edge.weight, true});
    for (const WeightedEdge& edge : spanned.undecided)
      rest.push_back({vertices[edge.a], vertices[edge.b], edge.weight, false});
  }
  if (passed_on) *passed_on += rest.size();
  const ScratchFolder folder;
  Scratch scratch(folder / "", 1 << 20);
  const auto for_each = [&](const auto& visit) { std::for_each(rest.begin(), rest.end(), visit); };
  add_loops(span_whole(whole.ids, for_each, e, 1 << 20, scratch), scratch, loops);
  std::sort(loops.begin(), loops.end());
  return loops;
}

TEST_CASE("the loops found part by part are those of the whole, for random graphs in random parts") {
  std::size_t passed_on = 0, all = 0, loops = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    Random random(seed);
    const std::int64_t width = random.whole(2, 14), height = random.whole(1, 14);
    const auto vertices = static_cast<LocalIndex>(width * height);
    Whole whole;
    std::vector<std::uint64_t> ids(vertices);
    for (LocalIndex v = 0; v < vertices; ++v) ids[v] = v;
    for (LocalIndex v = vertices; v > 1; --v)
      std::swap(ids[v - 1], ids[static_cast<std::size_t>(random.whole(0, v - 1))]);
    for (const std::uint64_t id : ids) whole.ids.push_back(PointId{id});
    // Between vertices near each other on a grid; some weights are equal.
    const double density = random.uniform(0.1, 1);
    for (LocalIndex a = 0; a < vertices; ++a) {
      for (LocalIndex b = a + 1; b < vertices; ++b) {
        const std::int64_t dx = std::abs(a % width - b % width), dy = b / width - a / width;
        if (dx <= 2 && dy <= 2 && random.chance(density))
          whole.edges.push_back({a, b, static_cast<double>(random.whole(0, 500)) * kProbabilityStep});
      }
    }
    const int parts = static_cast<int>(random.whole(1, 4));
    const std::int64_t stripe = random.whole(1, 8);
    std::vector<int> part_of;
    for (LocalIndex v = 0; v < vertices; ++v) {
      part_of.push_back(random.chance(0.02) ? static_cast<int>(random.whole(0, parts - 1))
                                            : static_cast<int>(v / width / stripe % parts));
    }
    const std::int64_t e = random.whole(1, 9);
    INFO("seed " << seed << ", e = " << e);
    const Loops expected = loops_of(whole.ids, whole.edges, e);
    CHECK(loops_by_parts(whole, part_of, parts, e, &passed_on) == expected);
    all += whole.edges.size();
    loops += expected.size();
  }
  CHECK(loops > 1000);
  CHECK(passed_on < all);
}

}  // namespace
}  // namespace lacuna::paper
