// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/synth/made.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <catch2/catch.hpp>

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

TEST_CASE("inside a true loop on a plane there is no point, and just outside there are") {
  const ScratchFolder folder;
  SurfaceOptions options = small_surface(folder);
  options.jitter = 0;
  write_surface(options);
  const auto points = positions_of(options.out);
  auto loops = loops_of(options.truth);
  std::sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  loops.pop_back();  // the outer edge
  for (const auto& loop : loops) {
    const std::set<std::uint64_t> on_loop(loop.begin(), loop.end());
    std::size_t inside = 0, beside = 0;
    for (std::uint64_t id = 0; id < points.size(); ++id) {
      if (on_loop.contains(id)) continue;
      bool within = false;
      double nearest = 1e30;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Position& p = points[id];
        const Position& a = points[loop[i]];
        const Position& b = points[loop[(i + 1) % loop.size()]];
        if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
          within = !within;
        nearest = std::min(nearest, distance(p, a));
      }
      inside += within;
      beside += nearest < 1.1 * options.spacing;
    }
    CHECK(inside == 0);
    CHECK(beside > loop.size() / 2);
  }
}

TEST_CASE("many small holes give as many loops, none of which touch") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder, SurfaceKind::kTorus);
    options.points = 600'000;
    options.holes = 1000;
    options.hole_radius = {1.5, 3};
    options.seed = seed;
    write_surface(options);
    std::set<std::uint64_t> seen;
    std::size_t nodes = 0;
    const auto loops = loops_of(options.truth);
    for (const auto& loop : loops) {
      seen.insert(loop.begin(), loop.end());
      nodes += loop.size();
    }
    CHECK(loops.size() == 1000);
    CHECK(seen.size() == nodes);
  }
}

TEST_CASE("random order has the points and the true loops of scanline order, in another order") {
  const auto places_of = [](const SurfaceOptions& options) {
    const auto points = positions_of(options.out);
    std::multiset<std::set<Position>> all;
    for (const auto& loop : loops_of(options.truth)) {
      std::set<Position> places;
      for (const std::uint64_t id : loop) places.insert(points[id]);
      all.insert(places);
    }
    return all;
  };
  for (const PositionKind positions : kAllPositions) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder, SurfaceKind::kWaves);
    options.positions = positions;
    write_surface(options);
    auto in_scanlines = positions_of(options.out);
    const auto loops_in_scanlines = places_of(options);
    options.order = Order::kRandom;
    write_surface(options);
    auto at_random = positions_of(options.out);
    CHECK(in_scanlines != at_random);
    CHECK(loops_in_scanlines == places_of(options));
    std::sort(in_scanlines.begin(), in_scanlines.end());
    std::sort(at_random.begin(), at_random.end());
    CHECK(in_scanlines == at_random);
  }
}

TEST_CASE("a density step on closed surfaces leaves no further loops") {
  for (const SurfaceKind kind : kAllKinds) {
    if (std::count(kPanelKinds.begin(), kPanelKinds.end(), kind) > 0) continue;
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder, kind);
    options.density_step = 4;
    write_surface(options);
    const auto points = positions_of(options.out);
    const auto loops = loops_of(options.truth);
    CHECK(loops.size() == 5 + rims_of(kind));
    for (const auto& loop : loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        CHECK(distance(points[loop[i]], points[loop[(i + 1) % loop.size()]]) < 6 * options.spacing);
  }
}
