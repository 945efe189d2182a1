// SPDX-License-Identifier: Apache-2.0
#include "engine/results/collect.hpp"

#include "engine/results/orientation.hpp"
#include "tests/support/detected.hpp"

namespace lacuna {
namespace {

using Place = std::array<double, 3>;

Place place_of(const Eigen::Vector3d& p) {
  return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
}

// The first reported loop through each place.
std::map<Place, std::int32_t> first_loops(const Detected& detected) {
  std::map<Place, std::int32_t> loops;
  for (std::size_t i = 0; i < detected.loops.size(); ++i) {
    for (const LoopPoint& p : detected.loops[i].points)
      loops.try_emplace(place_of(p.position()), static_cast<std::int32_t>(i));
  }
  return loops;
}

// Places on more than one reported loop.
std::size_t shared_places(const Detected& detected) {
  std::size_t points = 0;
  for (const ReportedLoop& loop : detected.loops) points += loop.points.size();
  return points - first_loops(detected).size();
}

void check_published(const Detected& detected, const Cloud& cloud) {
  const std::map<Place, std::int32_t> loops = first_loops(detected);
  REQUIRE(detected.points.size() == cloud.size());
  std::size_t wrong_loops = 0, wrong_boundary = 0, next = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const PointResult& p = detected.points[i];
    const bool usable = cloud.positions[i].allFinite();
    const auto loop = usable ? loops.find(place_of(cloud.positions[i])) : loops.end();
    wrong_loops += p.loop != (loop == loops.end() ? -1 : loop->second);
    wrong_boundary += p.loop >= 0 && p.boundary == 0;
    if (p.boundary == 0) continue;
    if (next == detected.boundary.size()) {
      FAIL_CHECK("point " << i << " is missing among the boundary points");
      return;
    }
    const BoundaryPoint& b = detected.boundary[next++];
    wrong_boundary += b.id != PointId{i} || b.position() != cloud.positions[i] || b.loop != p.loop ||
                      b.probability != p.probability;
  }
  CHECK(wrong_loops == 0);
  CHECK(wrong_boundary == 0);
  CHECK(next == detected.boundary.size());
  CHECK(detected.summary.counts.boundary_points == next);
}

TEST_CASE("a point names the first reported loop through it, and boundary points come in input order") {
  std::size_t shared = 0, unreported = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Cloud cloud = random_cloud(11'000 + seed).with_duplicates(50, seed);
    Config config = tiled(random_config(seed, typical_spacing(cloud)), 100);
    config.neighbourhood.eps_fraction = 0;
    INFO("seed " << seed);
    const Detected all = run_engine(cloud, config);
    check_published(all, cloud);
    shared += shared_places(all);

    // A loop that is not reported leaves its points on the boundary.
    config.selection.min_points = 20;
    const Detected some = run_engine(cloud, config);
    check_published(some, cloud);
    CHECK(some.summary.counts.raw_loops == all.summary.counts.raw_loops);
    CHECK(some.boundary.size() == all.boundary.size());
    unreported += all.loops.size() - some.loops.size();
    std::size_t different = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      different += some.points[i].boundary != all.points[i].boundary ||
                   some.points[i].coherent != all.points[i].coherent;
    }
    CHECK(different == 0);
  }
  CHECK(shared > 100);
  CHECK(unreported > 10);
}

TEST_CASE("results come in blocks of consecutive points, each point once, the boundary across all blocks") {
  const Cloud half = plane(280).punched({100, 100}, 10).jittered(0.2, 1);
  const Cloud cloud = half.joined(half.with_unusable(1000, 1));  // most have a duplicate in another block
  REQUIRE(cloud.size() > kResultBlock);
  MemoryScan scan(cloud, 5000);
  const Detected detected =
      run_engine(scan, {});  // requires that the blocks follow each other, none too large
  CHECK(detected.loops.size() == 2);
  check_published(detected, cloud);

  std::size_t different = 0;
  for (std::size_t i = 0; i < half.size(); ++i) {
    const PointResult &p = detected.points[i], &q = detected.points[half.size() + i];
    if (cloud.positions[half.size() + i].allFinite()) {
      different += p.probability != q.probability || p.boundary != q.boundary || p.loop != q.loop;
    } else {
      different += !std::isnan(q.probability) || q.boundary != 0 || q.loop != -1;
    }
  }
  CHECK(different == 0);
}

// ---- The sides of normals

OrientationEdge edge(double weight, std::uint64_t low, std::uint64_t high) {
  return {weight, PointId{low}, PointId{high}, Row{low}, Row{high}, 0};
}

TEST_CASE("a forest of parts' forests and the edges between is the forest of the whole") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    std::vector<OrientationEdge> all, low, high, reduced;
    for (std::uint64_t a = 0; a < 60; ++a) {
      for (std::uint64_t b = a + 1; b < 60; ++b)
        if (random.chance(0.1)) all.push_back(edge(double(random.whole(0, 5)) / 8, a, b));
    }
    for (const OrientationEdge& e : all) {
      if (value(e.high_id) < 30)
        low.push_back(e);
      else if (value(e.low_id) >= 30)
        high.push_back(e);
      else
        reduced.push_back(e);
    }
    for (const OrientationEdge& e : spanning_forest(low, 0, 30)) reduced.push_back(e);
    for (const OrientationEdge& e : spanning_forest(high, 30, 30)) reduced.push_back(e);
    const auto keys = [](std::vector<OrientationEdge> edges) {
      std::sort(edges.begin(), edges.end());
      std::vector<std::tuple<double, PointId, PointId>> keys;
      for (const OrientationEdge& e : edges) keys.emplace_back(e.weight, e.low_id, e.high_id);
      return keys;
    };
    CHECK(keys(spanning_forest(reduced, 0, 60)) == keys(spanning_forest(all, 0, 60)));
  }
}

}  // namespace
}  // namespace lacuna
