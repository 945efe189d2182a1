// SPDX-License-Identifier: Apache-2.0
// The paper's loops in any memory and any tiles, against the plain method; and found part by part.
#include "engine/boundary/paper/paper_boundary.hpp"

#include "engine/boundary/paper/loops.hpp"
#include "engine/boundary/paper/spanning.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna::paper {
namespace {

using IdLoops = std::vector<std::vector<PointId>>;

struct Traced {
  IdLoops loops;
  std::uint64_t eligible_edges, components;
  std::size_t wrong_points = 0;

  friend bool operator==(const Traced&, const Traced&) = default;
};

// `global_memory`: bytes for the global stage; 0: as many as the run gives it.
Traced trace(const Cloud& cloud, const Config& config, std::uint64_t global_memory) {
  TiledScan scan(cloud, config);
  PaperBoundary boundary(scan.store.tiling(), scan.config.spanning, scan.job.spill, scan.job.workers);
  const TileOutputs outputs =
      scan.evaluate({[&](const EvaluatedTile& tile, TileOutput& output) { boundary.emit(tile, output); }});
  if (global_memory > 0) scan.job.workers.memory.work = global_memory;
  const FoundLoops traced = scan.find_loops(boundary, outputs);
  Traced result{.eligible_edges = traced.edges, .components = traced.components};
  for (std::size_t i = 0; i < traced.loops.size(); ++i) {
    result.loops.emplace_back();
    traced.loops.for_each_point(i, [&](const LoopPoint& p) {
      result.loops.back().push_back(p.id);
      result.wrong_points += p.position() != cloud.positions[value(p.id)];
    });
    CHECK(traced.loops.count(i) == result.loops.back().size());
  }
  return result;
}

// Edges of each component of the graph of eligible edges, most first.
std::vector<std::size_t> component_sizes(const reference::Detection& plain) {
  std::vector<std::size_t> tree(plain.points.size()), edges(plain.points.size());
  std::iota(tree.begin(), tree.end(), std::size_t{0});
  const auto root = [&](PointId id) {
    std::size_t i = value(id);
    while (tree[i] != i) i = tree[i] = tree[tree[i]];
    return i;
  };
  for (const reference::Edge& edge : plain.eligible) tree[root(edge.low)] = root(edge.high);
  for (const reference::Edge& edge : plain.eligible) ++edges[root(edge.low)];
  std::erase(edges, 0u);
  std::sort(edges.rbegin(), edges.rend());
  return edges;
}

// A plane whose every edge is eligible, some islands with an outer edge each, and specks without loops.
Cloud plane_and_islands() {
  Cloud cloud = plane(50).punched({15, 15}, 5).punched({34, 30}, 7).jittered(0.3, 1);
  for (int i = 0; i < 12; ++i)
    cloud = cloud.joined(plane(6 + i).jittered(0.2, std::uint64_t(i)).translated({70. + 30 * i, 0, 0}));
  for (int i = 0; i < 20; ++i) cloud = cloud.joined(sphere(20).scaled(2).translated({20. * i, -50, 0}));
  return cloud.shuffled(1);
}

Config everything_eligible() {
  Config config = with_paper_loops({});
  config.spanning.max_prob_weight = 2.1;
  config.spanning.max_total_weight = 4;
  config.spanning.e = 12;
  return config;
}

TEST_CASE("an edge is eligible only strictly below both thresholds") {
  const SpanningConfig config{.max_prob_weight = 1.0, .max_total_weight = 3.0};
  const float step = 0x1p-24f;
  CHECK(eligible_weight({1.0, 0.5f}, {1.0, 0.5f}, 1.0, config) < 0);
  CHECK(eligible_weight({1.0, 0.5f + step}, {1.0, 0.5f}, 1.0, config) == 2.0 - 0x1p-24);
  CHECK(eligible_weight({1.0, 1.0f}, {1.0, 1.0f}, 3.0, config) < 0);
  CHECK(eligible_weight({1.0, 1.0f}, {1.0, 1.0f}, 2.9375, config) == 2.9375);
  CHECK(eligible_weight({2.0, 1.0f}, {4.0, 1.0f}, 3.0, config) == 1.0);
}

TEST_CASE("a component larger than the memory of the global stage has the loops that it has in memory") {
  const Cloud cloud = plane_and_islands();
  const Config config = everything_eligible();
  const reference::Detection plain = reference::detect(cloud.positions, {}, config);
  const std::vector<std::size_t> components = component_sizes(plain);
  const Traced expected{reference::in_report_order(plain.loops), plain.eligible.size(), components.size()};
  REQUIRE(components.size() > 20);
  REQUIRE(components[0] > 10'000);  // 32 bytes each and more; below, from all of them down to none fit
  REQUIRE(components[5] < 2'000);
  CHECK(expected.loops.size() > 10);
  for (const std::uint64_t memory : {0, 1 << 20, 1 << 18, 1 << 14, 1}) {
    for (const std::int64_t tile_points : {40, 500}) {
      if (tile_points == 40 && memory != 1) continue;  // small tiles with the least memory
      INFO(memory << " bytes, " << tile_points << " points a tile");
      const bool same = trace(cloud, tiled(config, tile_points), memory) == expected;
      CHECK(same);
    }
  }
}

// Returns how many loops there are.
std::size_t check_drawn(std::uint64_t first, std::uint64_t last) {
  std::size_t loops = 0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Cloud cloud = random_cloud(10'000 + seed);
    Config config = with_paper_loops(random_config(seed, typical_spacing(cloud)));
    config.neighbourhood.eps_fraction = 0;
    config.normals.orient = false;
    INFO("seed " << seed);
    const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
    const Traced traced = trace(cloud, tiled(config, std::int64_t(1 + 7 * (seed % 10)), 8), 1);
    CHECK(traced.loops == reference::in_report_order(plain.loops));
    CHECK(traced.eligible_edges == plain.eligible.size());
    CHECK(traced.components == component_sizes(plain).size());
    CHECK(traced.wrong_points == 0);
    loops += traced.loops.size();
  }
  return loops;
}

TEST_CASE("random clouds have the loops of the plain method in as little memory as there is") {
  CHECK(check_drawn(1, 10) > 20);
}

TEST_CASE("many more random clouds have the loops of the plain method in as little memory as there is",
          "[.slow]") {
  CHECK(check_drawn(11, 100) > 200);
}

// ---- Part by part

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

TEST_CASE("a long path with a ring at its end is searched without recursion") {
  constexpr LocalIndex n = 300'000;  // from n - 1, an edge leads 19 back
  std::vector<PointId> ids;
  std::vector<std::uint64_t> offsets{0};
  std::vector<LocalIndex> indices;
  for (LocalIndex v = 0; v < n; ++v) {
    ids.push_back(PointId{v});
    if (v == n - 1) indices.push_back(n - 20);
    if (v > 0) indices.push_back(v - 1);
    if (v + 1 < n) indices.push_back(v + 1);
    if (v == n - 20) indices.push_back(n - 1);
    offsets.push_back(indices.size());
  }
  const ScratchFolder folder;
  Scratch scratch(folder / "", 1 << 20);
  std::vector<std::size_t> sizes;
  find_loops(keep_cycles({ids, offsets, indices}, scratch), scratch,
             [&](std::span<const LocalIndex> loop) { sizes.push_back(loop.size()); });
  CHECK(sizes == std::vector<std::size_t>{20});
}

}  // namespace
}  // namespace lacuna::paper
