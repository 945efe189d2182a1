// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/permutation.hpp"
#include "tests/bench/synth/made.hpp"

using namespace lacuna;
using namespace lacuna::synth;

TEST_CASE("every planted hole and every outer edge is one closed true loop in canonical form") {
  const auto check = [](SurfaceKind kind, Order order, PositionKind positions) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder, kind);
    options.order = order;
    options.positions = positions;
    const SurfaceSummary made = write_surface(options);
    const auto points = positions_of(options.out);
    const auto loops = loops_of(options.truth);
    CHECK(points.size() == made.points);
    CHECK(std::fabs(double(made.points) - 20'000) < 500);
    REQUIRE(loops.size() == 5 + rims_of(kind));
    CHECK(std::is_sorted(loops.begin(), loops.end()));
    std::set<std::uint64_t> seen;
    double widest = 0;
    for (const auto& loop : loops) {
      REQUIRE(loop.size() >= 8);
      CHECK(*std::min_element(loop.begin(), loop.end()) == loop.front());
      CHECK(loop[1] < loop.back());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        REQUIRE(loop[i] < points.size());
        CHECK(seen.insert(loop[i]).second);
        widest = std::max(widest, distance(points[loop[i]], points[loop[(i + 1) % loop.size()]]));
      }
    }
    CHECK(widest < (positions == PositionKind::kRandom ? 6 : 3) * options.spacing);
  };
  for (const SurfaceKind kind : kAllKinds)
    for (const Order order : {Order::kScanline, Order::kRandom})
      for (const PositionKind positions : kAllPositions) check(kind, order, positions);
}

TEST_CASE("the true loops are the edges with exactly one whole quad, all of them") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder);
    options.points = 60'000;
    options.holes = 60;
    options.hole_radius = {1.5, 4};
    options.jitter = 0;
    options.seed = seed;
    options.order = Order::kRandom;
    write_surface(options);
    using Node = std::array<int, 2>;
    using Edge = std::set<Node>;
    std::vector<Node> nodes;
    for (const Position& p : positions_of(options.out))
      nodes.push_back({int(std::lround(p[0] / options.spacing)), int(std::lround(p[1] / options.spacing))});
    const std::set<Node> there(nodes.begin(), nodes.end());
    std::map<Edge, int> quads_at;
    for (const auto& [x, y] : there) {
      if (!there.contains({x + 1, y}) || !there.contains({x, y + 1}) || !there.contains({x + 1, y + 1}))
        continue;
      ++quads_at[{{x, y}, {x + 1, y}}];
      ++quads_at[{{x, y + 1}, {x + 1, y + 1}}];
      ++quads_at[{{x, y}, {x, y + 1}}];
      ++quads_at[{{x + 1, y}, {x + 1, y + 1}}];
    }
    std::set<Edge> expected, found;
    for (const auto& [edge, quads] : quads_at)
      if (quads == 1) expected.insert(edge);
    for (const auto& loop : loops_of(options.truth))
      for (std::size_t i = 0; i < loop.size(); ++i)
        CHECK(found.insert({nodes.at(loop[i]), nodes.at(loop[(i + 1) % loop.size()])}).second);
    CHECK(found == expected);
  }
}

TEST_CASE("random order has the points and the true loops of scanline order, in another order") {
  for (const PositionKind positions : kAllPositions) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder, SurfaceKind::kWaves);
    options.positions = positions;
    write_surface(options);
    auto in_scanlines = positions_of(options.out);
    const auto loops_in_scanlines = places_of(loops_of(options.truth), in_scanlines);
    options.order = Order::kRandom;
    write_surface(options);
    auto at_random = positions_of(options.out);
    CHECK(in_scanlines != at_random);
    CHECK(loops_in_scanlines == places_of(loops_of(options.truth), at_random));
    std::sort(in_scanlines.begin(), in_scanlines.end());
    std::sort(at_random.begin(), at_random.end());
    CHECK(in_scanlines == at_random);
  }
}

TEST_CASE("a permutation visits every index once, for every size") {
  for (std::uint64_t size = 1; size <= 300; ++size) {
    const Permutation order(size, size);
    std::vector<int> met(size);
    for (std::uint64_t index = 0; index < size; ++index) ++met.at(order(index));
    CHECK(met == std::vector<int>(size, 1));
  }
}
