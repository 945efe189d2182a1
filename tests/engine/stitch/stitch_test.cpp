// SPDX-License-Identifier: Apache-2.0
#include "engine/stitch/stitch.hpp"

#include "engine/config/job.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

// An edge between two rows; each tile has a hundred.
struct Edge {
  Row a, b;

  friend auto operator<=>(const Edge&, const Edge&) = default;
};

constexpr std::uint64_t kTilePoints = 100;

std::uint64_t tile_of(Row row) {
  return value(row) / kTilePoints;
}

using Component = std::vector<Edge>;  // sorted

struct Stitched {
  std::set<Component> components;  // with their edges, each in the list of the tile of its lower row
  std::uint64_t count = 0;
};

// By tile: the edges with an end there.
TileGraph<Edge> graph_of(std::uint64_t tile, const std::vector<Edge>& edges, std::vector<LocalIndex>& links) {
  links.assign(kTilePoints, 0);
  UnionFind connected(links);
  TileGraph<Edge> graph{.vertices = kTilePoints, .links = links};
  const auto local = [&](Row row) { return static_cast<LocalIndex>(value(row) - tile * kTilePoints); };
  for (const Edge& edge : edges) {
    const bool has_a = tile_of(edge.a) == tile, has_b = tile_of(edge.b) == tile;
    if (has_a && has_b) connected.unite(local(edge.a), local(edge.b));
    if (has_a != has_b) {
      const Row own = has_a ? edge.a : edge.b;
      graph.crossings.push_back({local(own), own, has_a ? edge.b : edge.a});
    }
  }
  std::set<LocalIndex> open;  // roots
  for (const CrossingEdge& crossing : graph.crossings) open.insert(connected.find(crossing.vertex));
  for (const Edge& edge : edges) {
    if (tile_of(edge.a) != tile || !open.contains(connected.find(local(edge.a)))) continue;
    graph.records.push_back(edge);
    graph.vertex_of.push_back(local(edge.a));
  }
  return graph;
}

Stitched stitch(const std::vector<Edge>& edges, std::uint64_t tiles, std::uint64_t memory,
                std::int64_t threads) {
  const ScratchFolder folder;
  Workers workers = workers_of({.threads = threads});
  workers.memory.work = memory;
  const Spill spill{folder.path(), std::make_shared<BufferPool>(workers.memory.lists)};
  Stitch<Edge> stitch(tiles, sizeof(Edge), spill, workers);
  Stitched result;
  std::mutex mutex;
  const auto add = [&](Component component) {
    std::sort(component.begin(), component.end());
    const std::lock_guard lock(mutex);
    CHECK(result.components.insert(component).second);
  };
  workers.arena.for_each(tiles, [&](std::size_t t) {
    std::vector<LocalIndex> links;
    stitch.add(static_cast<TileIndex>(t), graph_of(t, edges, links));
  });
  stitch.for_each_component([&](const auto& for_each, std::uint64_t count, std::uint64_t) {
    Component component;
    for_each([&](const Edge& edge) { component.push_back(edge); });
    CHECK(component.size() == count);
    add(component);
  });
  result.count = stitch.components();
  return result;
}

// By a plain union-find over all rows: the components that lie in several tiles, and the number of all.
Stitched stitch_plainly(const std::vector<Edge>& edges, std::uint64_t tiles) {
  std::vector<std::uint64_t> root(tiles * kTilePoints);
  std::iota(root.begin(), root.end(), std::uint64_t{0});
  const auto find = [&](Row row) {
    std::uint64_t x = value(row);
    while (root[x] != x) x = root[x];
    return x;
  };
  for (const Edge& edge : edges) root[find(edge.a)] = find(edge.b);
  std::map<std::uint64_t, Component> components;
  std::map<std::uint64_t, std::set<std::uint64_t>> tiles_of;
  for (const Edge& edge : edges) {
    components[find(edge.a)].push_back(edge);
    tiles_of[find(edge.a)].insert({tile_of(edge.a), tile_of(edge.b)});
  }
  Stitched result{.count = components.size()};
  for (auto& [name, component] : components) {
    std::sort(component.begin(), component.end());
    if (tiles_of[name].size() > 1) result.components.insert(component);
  }
  return result;
}

std::vector<Edge> random_edges(std::uint64_t seed, std::uint64_t tiles) {
  Random random(seed);
  const auto rows = static_cast<std::int64_t>(tiles * kTilePoints);
  const double density = 0.2 + 0.1 * static_cast<double>(seed % 8);  // below and above percolation
  std::set<Edge> edges;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(density * static_cast<double>(rows)); ++i) {
    const std::int64_t a = random.whole(0, rows - 1);
    const std::int64_t b = random.chance(0.8) ? std::clamp<std::int64_t>(a + random.whole(-5, 5), 0, rows - 1)
                                              : random.whole(0, rows - 1);
    if (a != b) edges.insert({Row(std::min(a, b)), Row(std::max(a, b))});
  }
  return {edges.begin(), edges.end()};
}

TEST_CASE("components of random graphs are those of a plain union-find, in any memory") {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const std::uint64_t tiles = 1 + seed % 7;
    const std::vector<Edge> edges = random_edges(seed, tiles);
    const Stitched expected = stitch_plainly(edges, tiles);
    INFO("seed " << seed << ", " << tiles << " tiles");
    for (const std::uint64_t memory : {1 << 20, 2'000, 1}) {
      const Stitched found = stitch(edges, tiles, memory, seed % 2 == 0 ? 8 : 1);
      CHECK(found.components == expected.components);
      CHECK(found.count == expected.count);
    }
  }
}

}  // namespace
}  // namespace lacuna
