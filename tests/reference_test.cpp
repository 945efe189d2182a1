// SPDX-License-Identifier: Apache-2.0
#include "tests/support/reference.hpp"

#include "engine/run/error.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/golden.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <catch2/catch.hpp>
#include <Eigen/Geometry>

namespace lacuna {
namespace {

using Eigen::Vector3d;
using reference::Detection;
using reference::Edge;
using reference::Point;

// By the method of the paper.
Detection detect(const Cloud& cloud, const Config& config = {}) {
  return reference::detect(cloud.positions, cloud.normals, with_paper_loops(config));
}

constexpr double kDegree = std::numbers::pi / 180;

std::size_t index(PointId id) {
  return std::size_t(value(id));
}

double squared_distance(const Cloud& cloud, std::size_t i, std::size_t j) {
  const Vector3d d = cloud.positions[j] - cloud.positions[i];
  return (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z();
}

// Neighbours, from the definition: every pair of distinct points is looked at.
std::vector<std::vector<PointId>> brute_force_neighbours(const Cloud& cloud, const Detection& result,
                                                         std::int64_t k) {
  const std::size_t n = cloud.size();
  std::vector<std::vector<std::pair<double, PointId>>> own(n);
  for (PointId p : result.distinct) {
    auto& row = own[index(p)];
    for (PointId q : result.distinct) {
      if (p != q) row.emplace_back(squared_distance(cloud, index(p), index(q)), q);
    }
    std::sort(row.begin(), row.end());
    std::size_t kept = std::min(row.size(), std::size_t(k));
    while (kept < row.size() && row[kept].first <= result.eps * result.eps) ++kept;
    row.resize(kept);
  }
  std::vector<std::set<std::pair<double, PointId>>> closure(n);
  for (PointId p : result.distinct) {
    for (const auto& [squared, q] : own[index(p)]) {
      closure[index(p)].emplace(squared, q);
      closure[index(q)].emplace(squared, p);
    }
  }
  std::vector<std::vector<PointId>> neighbours(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (const auto& [squared, q] :
         closure[result.points[i].dropped ? i : index(result.points[i].representative)]) {
      neighbours[i].push_back(q);
    }
  }
  return neighbours;
}

// All loops lie within `tolerance` of the true edge, whose distance from a point `away` gives.
template <typename Distance>
bool lies_on(const std::vector<PointId>& loop, const Cloud& cloud, double tolerance, const Distance& away) {
  return std::all_of(loop.begin(), loop.end(),
                     [&](PointId p) { return away(cloud.positions[index(p)]) <= tolerance; });
}

Config defaults_with_e(std::int64_t e) {
  Config config;
  config.spanning.e = e;
  return config;
}

}  // namespace

// ---- Golden ------------------------------------------------------------------------------------------

TEST_CASE("the reference gives the golden results on real scans") {
  const auto shared = shared_folder();
  if (!shared) return;
  for (const GoldenSetting& setting : golden_settings()) {
    INFO(setting.name);
    const Cloud cloud = read_cloud(*shared / setting.cloud);
    const std::vector<GoldenPoint> golden = read_golden_points(*shared, setting);
    const Detection result = detect(cloud, setting.config);
    std::vector<GoldenPoint> found;
    for (const Point& p : result.points) {
      found.push_back({.angle = p.angle,
                       .halfdisc = p.halfdisc,
                       .shape = p.shape,
                       .probability = p.probability,
                       .mean_distance = p.mean_distance,
                       .neighbours = std::int64_t(p.neighbours.size()),
                       .coherent = p.coherent,
                       .gap_near = p.gap ? std::int64_t(value((*p.gap)[0])) : -1,
                       .gap_far = p.gap ? std::int64_t(value((*p.gap)[1])) : -1});
    }
    check_golden(found, golden);
    CHECK(in_golden_form(result.loops) == read_golden_loops(*shared, setting));
  }
}

TEST_CASE("the bunny has five loops with the defaults, and e is 14") {
  const auto shared = shared_folder();
  if (!shared) return;
  const Detection result = detect(read_cloud(*shared / "data/bun_zipper.ply"));
  CHECK(result.e == 14);
  CHECK(result.loops.size() == 5);
}

TEST_CASE("a range map has one loop of 844 points when only long loops may close") {  // the paper's figure 15
  const auto shared = shared_folder();
  if (!shared) return;
  const Detection result = detect(read_cloud(*shared / "data/bun000.ply"), defaults_with_e(500));
  REQUIRE(result.loops.size() == 1);
  CHECK(result.loops[0].size() == 844);
}

// ---- Analytic ----------------------------------------------------------------------------------------

TEST_CASE("a sphere has no loop and no boundary point") {
  const Detection result = detect(sphere(2000));
  CHECK(result.loops.empty());
  CHECK(std::none_of(result.points.begin(), result.points.end(), [](const Point& p) { return p.boundary; }));
}

TEST_CASE("an open cylinder has two loops, its edges") {
  const Cloud cloud = open_cylinder(60, 30);
  const Detection result = detect(cloud);
  REQUIRE(result.loops.size() == 2);
  for (double z : {0., 29.}) {
    CHECK(std::count_if(result.loops.begin(), result.loops.end(), [&](const std::vector<PointId>& loop) {
            return loop.size() >= 50 &&
                   lies_on(loop, cloud, 1.01, [&](const Vector3d& p) { return std::abs(p.z() - z); });
          }) == 1);
  }
}

TEST_CASE("a punched plane has two loops, the hole and the outer curve") {
  const Cloud cloud = plane(40).punched({20, 20}, 5).jittered(0.05, 1);
  const Detection result = detect(cloud);
  REQUIRE(result.loops.size() == 2);
  const auto& rim = result.loops[result.loops[0].size() > result.loops[1].size() ? 0 : 1];
  const auto& hole = result.loops[result.loops[0].size() > result.loops[1].size() ? 1 : 0];
  CHECK(rim.size() >= 4 * 36);
  CHECK(lies_on(rim, cloud, 1.2, [](const Vector3d& p) {
    return std::min({p.x(), p.y(), 39 - p.x(), 39 - p.y()});
  }));
  CHECK(lies_on(hole, cloud, 1.5, [](const Vector3d& p) { return std::hypot(p.x() - 20, p.y() - 20) - 5; }));
}

TEST_CASE(
    "a density step of one to four has no loop along it, only the outer curve") {  // the paper's figure 11
  const Cloud cloud = density_step(60).jittered(0.25, 3);
  const Detection result = detect(cloud);
  REQUIRE(result.loops.size() == 1);
  CHECK(lies_on(result.loops[0], cloud, 2.6, [](const Vector3d& p) {
    return std::min({p.x(), p.y(), 58.5 - p.x(), 59 - p.y()});
  }));
}

TEST_CASE("the loops stay the same a million units away") {
  const Cloud cloud = plane(30).punched({15, 15}, 5).jittered(0.1, 5).rounded(0x1p-20);
  const Detection here = detect(cloud);
  const Detection there = detect(cloud.translated({1e6, -1e6, 1e6}));
  CHECK(!here.loops.empty());
  CHECK(here.loops == there.loops);
  CHECK(here.spanning == there.spanning);
}

TEST_CASE("a scan scaled by a power of two has the same results") {
  const Cloud cloud = random_cloud(12);
  const Detection once = detect(cloud);
  const Detection scaled = detect(cloud.scaled(0x1p-30));
  CHECK(once.loops == scaled.loops);
  CHECK(once.eligible == scaled.eligible);
}

TEST_CASE("a rotated scan has the same loops") {
  const Cloud cloud = plane(30).punched({15, 15}, 5).jittered(0.1, 5);
  CHECK(detect(cloud).loops == detect(cloud.rotated({1, 2, 3}, 37)).loops);
}

// ---- Neighbourhoods ----------------------------------------------------------------------------------

TEST_CASE("neighbours are those of a brute force search, in order, on random clouds") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    INFO("seed " << seed);
    const Cloud cloud = random_cloud(seed);
    if (cloud.size() > 1000) continue;
    const Config config = random_config(seed, typical_spacing(cloud));
    const Detection result = detect(cloud, config);
    const auto expected = brute_force_neighbours(cloud, result, config.neighbourhood.k);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) differing += result.points[i].neighbours != expected[i];
    CHECK(differing == 0);
  }
}

TEST_CASE("neighbours are those of a brute force search on the hard cloud, where most distances tie") {
  const Cloud cloud = hard_cloud(1).joined(lattice(6).translated({16, 16, 16}));
  Config config;
  config.neighbourhood.eps = 1;  // the step of the lattice, exactly
  const Detection result = detect(cloud, config);
  const auto expected = brute_force_neighbours(cloud, result, config.neighbourhood.k);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) differing += result.points[i].neighbours != expected[i];
  CHECK(differing == 0);
}

TEST_CASE("equal distances are decided by id") {
  Config config;
  config.neighbourhood.k = 1;
  // The origin has two neighbours at distance 1; one of them has a nearer one of its own.
  const Vector3d origin(0, 0, 0), right(1, 0, 0), left(-1, 0, 0), beyond(-1.5, 0, 0);
  CHECK(detect({{origin, right, left, beyond}, {}}, config).points[0].neighbours == std::vector{PointId{1}});
  CHECK(detect({{origin, left, right, beyond}, {}}, config).points[0].neighbours ==
        std::vector{PointId{1}, PointId{2}});
}

TEST_CASE("points at the eps distance exactly are neighbours") {
  Config config;
  config.neighbourhood.k = 1;
  config.neighbourhood.eps = 2;
  const Detection result = detect(line(5), config);
  CHECK(result.points[0].neighbours == std::vector{PointId{1}, PointId{2}});
  CHECK(result.points[2].neighbours == std::vector{PointId{1}, PointId{3}, PointId{0}, PointId{4}});
}

TEST_CASE("eps as a fraction is taken of the diagonal of all finite points") {
  Config config;
  config.neighbourhood.eps_fraction = 0.5;
  const double nan = std::nan("");
  const Cloud cloud{{{0, 0, 0}, {3, 4, 0}, {1e9, nan, 0}, {0, 0, 0}}, {}};
  CHECK(detect(cloud, config).eps == 2.5);
}

TEST_CASE("coincident points are one point, and all of them have its results") {
  const Cloud once = plane(10);
  const Detection expected = detect(once);
  const Detection result = detect(once.joined(once));
  CHECK(result.distinct == expected.distinct);
  CHECK(result.loops == expected.loops);
  CHECK(result.mean_neighbours == expected.mean_neighbours);
  for (std::size_t i = 0; i < once.size(); ++i) {
    CHECK(result.points[100 + i].representative == PointId{i});
    CHECK(result.points[100 + i].probability == expected.points[i].probability);
    CHECK(result.points[100 + i].neighbours == expected.points[i].neighbours);
  }
}

TEST_CASE("minus zero is zero") {
  const Cloud cloud{{{0., 0., 1.}, {-0., 0., 1.}, {1., 1., 1.}}, {}};
  CHECK(detect(cloud).distinct == std::vector{PointId{0}, PointId{2}});
}

TEST_CASE("points that are not finite are dropped and keep their id") {
  const Cloud cloud = plane(12);
  Cloud with = cloud;
  with.positions.insert(with.positions.begin() + 7, Vector3d(0, std::nan(""), 0));
  const Detection result = detect(with), expected = detect(cloud);
  CHECK(result.points[7].dropped);
  CHECK(result.points[7].neighbours.empty());
  CHECK(result.distinct.size() == 144);
  CHECK(result.points[100].probability == expected.points[99].probability);
}

TEST_CASE("no points give no results") {
  for (const Cloud& cloud : {Cloud{}, plane(1).with_unusable(1, 1)}) {
    const Detection result = detect(cloud);
    CHECK(result.distinct.empty());
    CHECK(result.loops.empty());
    CHECK(result.mean_neighbours == 0);
  }
}

TEST_CASE("a point without neighbours has all probabilities 1 and is not coherent") {
  for (const Cloud& cloud : {line(1), coincident(2000)}) {
    const Point point = detect(cloud).points.back();
    CHECK(point.angle == 1);
    CHECK(point.halfdisc == 1);
    CHECK(point.shape == 1);
    CHECK(point.probability == 1);
    CHECK(point.mean_distance == 0);
    CHECK(!point.coherent);
  }
}

TEST_CASE("distinct points whose squared distance is zero or infinite are refused") {
  CHECK_THROWS_AS(detect({{{0, 0, 0}, {1e-170, 0, 0}, {1, 0, 0}}, {}}), Error);
  CHECK_THROWS_AS(detect({{{0, 0, 0}, {1e170, 0, 0}, {1, 0, 0}}, {}}), Error);
}

// ---- Normals and criteria ----------------------------------------------------------------------------

TEST_CASE("collinear neighbours define no normal: angle and halfdisc are 1, and there is no gap") {
  const Detection result = detect(line(40));
  for (const Point& p : result.points) {
    CHECK(!p.normal);
    CHECK(p.angle == 1);
    CHECK(p.halfdisc == 1);
    CHECK(!p.gap);
    CHECK(!p.coherent);
    CHECK(p.shape < 0.01);  // the line's share is nearly all
  }
}

TEST_CASE("a given normal is used, whatever its length, where the neighbours define none") {
  Cloud cloud = line(40);
  cloud.normals.assign(40, Vector3d(0, 0, 1e-200));
  cloud.normals[3] = Vector3d(0, 0, 0);
  const Detection result = detect(cloud);
  REQUIRE(result.points[20].normal);
  CHECK(*result.points[20].normal == Vector3d(0, 0, 1));
  CHECK(!result.points[3].normal);
  // Two directions, half a turn apart, each seen several times: m is counted before they become one.
  CHECK(result.points[20].angle == Approx(1));
  REQUIRE(result.points[20].gap);
  CHECK(*result.points[20].gap == std::array{PointId{19}, PointId{21}});
}

TEST_CASE("one direction is both gap neighbours, and two points have an angle probability of 1") {
  Cloud cloud = line(2);
  cloud.normals.assign(2, Vector3d(0, 0, 1));
  const Point point = detect(cloud).points[0];
  CHECK(point.angle == 1);
  REQUIRE(point.gap);
  CHECK(*point.gap == std::array{PointId{1}, PointId{1}});
}

TEST_CASE("neighbours along the normal line have no direction") {
  Cloud cloud{{{0, 0, 0}, {0, 0, 1}, {0, 0, -2}}, {}};
  cloud.normals.assign(3, Vector3d(0, 0, 1));
  for (double cone : {0., 15.}) {
    Config config;
    config.criteria.cone = cone;
    const Point point = detect(cloud, config).points[0];
    CHECK(point.angle == 1);
    CHECK(!point.gap);
  }
}

TEST_CASE("neighbours in one direction count each, but the nearest alone stands for them, across pi too") {
  // Two neighbours to the right, 1e-10 rad to either side; the others at 100 and 200 degrees.
  const auto at = [](double degrees, double r) {
    return Vector3d(r * std::cos(degrees * kDegree), r * std::sin(degrees * kDegree), 0);
  };
  for (double side : {-1e-10, 1e-10}) {
    Cloud cloud{{{0, 0, 0}, {1, side, 0}, {2, -2 * side, 0}, at(100, 1.5), at(200, 1.6)}, {}};
    cloud.normals.assign(5, Vector3d(0, 0, 1));
    for (int quarter = 0; quarter < 4; ++quarter) {  // in one of them they lie across pi
      const Point point = detect(cloud).points[0];
      CHECK(point.angle == Approx((160. - 90.) / (180. - 90.)).epsilon(1e-8));
      REQUIRE(point.gap);
      CHECK(*point.gap == std::array{PointId{1}, PointId{4}});
      for (Vector3d& p : cloud.positions) p = Vector3d(-p.y(), p.x(), 0);
    }
  }
}

TEST_CASE("of gaps that tie the pair that comes first in the order of neighbours is taken") {
  Config config;
  config.neighbourhood.k = 8;
  const Detection result = detect(plane(9), config);
  const Point& centre = result.points[40];
  REQUIRE(centre.neighbours.size() == 8);
  CHECK(centre.angle == Approx(0).margin(1e-12));
  // 31 (below), 39 (left), 41, 49 at distance 1; then 30, 32, 48, 50: of eight equal gaps, 31 to 30.
  CHECK(*centre.gap == std::array{PointId{31}, PointId{30}});
}

TEST_CASE(
    "the halfdisc and angle probabilities of a point on a straight edge are high, inside they are low") {
  const Detection result = detect(plane(40).jittered(0.05, 2));
  const Point &edge = result.points[20], &inside = result.points[20 * 40 + 20];
  CHECK(edge.angle > 0.9);
  CHECK(edge.halfdisc > 0.7);
  CHECK(edge.probability > 0.5);
  CHECK(inside.angle < 0.3);
  CHECK(inside.halfdisc < 0.2);
  CHECK(inside.probability < 0.3);
}

TEST_CASE("every probability lies in [0, 1] and Pi is a multiple of 2^-24, on random clouds and settings") {
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    INFO("seed " << seed);
    const Cloud cloud = random_cloud(seed);
    const Detection result = detect(cloud, random_config(seed, typical_spacing(cloud)));
    std::size_t outside = 0, not_rounded = 0;
    for (const Point& p : result.points) {
      for (double x : {p.angle, p.halfdisc, p.shape, p.probability}) outside += !(x >= 0 && x <= 1);
      not_rounded += p.probability * 0x1p24 != std::floor(p.probability * 0x1p24);
    }
    CHECK(outside == 0);
    CHECK(not_rounded == 0);
  }
}

TEST_CASE("on the ridge of a sharp crease the normal is turned by 90 degrees, unless it was given") {
  // Both sides of the ridge lie on one side of it, as seen along the estimated normal.
  const Cloud cloud = crease(20, 40).noisy(0.02, 4);
  const auto turned = [&](const Detection& result) {
    return std::count_if(result.points.begin(), result.points.end(), [](const Point& p) { return p.turned; });
  };
  const Vector3d across(std::cos(110 * kDegree), 0, std::sin(110 * kDegree));
  Config sharp;
  sharp.neighbourhood.k = 20;  // whole shells of the grid: the estimate is not tilted
  const Detection result = detect(cloud, sharp);
  Config never = sharp;
  never.normals.crease_threshold = 1;
  const Detection plain = detect(cloud, never);
  for (int y = 4; y < 16; ++y) {
    const std::size_t ridge = std::size_t(20 * y);
    CHECK(result.points[ridge].turned);
    CHECK(std::abs(result.points[ridge].normal->dot(across)) < 0.2);
    CHECK(std::abs(plain.points[ridge].normal->dot(across)) > 0.95);
    CHECK(result.points[ridge].angle < plain.points[ridge].angle / 2);
  }
  CHECK(turned(plain) == 0);
  Cloud given = cloud;
  for (const Point& p : plain.points) given.normals.push_back(*p.normal);
  CHECK(turned(detect(given, sharp)) == 0);
}

TEST_CASE("oriented normals of a sphere all point outwards") {
  Config config;
  config.normals.orient = true;
  const Cloud cloud = sphere(1500);
  const Detection result = detect(cloud, config);
  CHECK(std::all_of(result.distinct.begin(), result.distinct.end(), [&](PointId p) {
    return result.points[index(p)].oriented_normal->dot(cloud.positions[index(p)]) > 0.9;
  }));
}

// ---- Coherence, spanning graph, loops ----------------------------------------------------------------

TEST_CASE(
    "every coherent point has two coherent gap neighbours, and no candidate was left out that could stay") {
  for (std::uint64_t seed = 200; seed < 220; ++seed) {
    INFO("seed " << seed);
    const Cloud cloud = random_cloud(seed);
    const Config config = random_config(seed, typical_spacing(cloud));
    const Detection result = detect(cloud, config);
    std::size_t wrong = 0;
    for (PointId id : result.distinct) {
      const Point& p = result.points[index(id)];
      const bool kept = p.probability > config.coherence.threshold && p.gap &&
                        result.points[index((*p.gap)[0])].coherent &&
                        result.points[index((*p.gap)[1])].coherent;
      wrong += p.coherent != kept;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a point at the threshold exactly is no candidate") {
  const Cloud cloud = open_cylinder(40, 12);
  const Detection before = detect(cloud);
  Config config;
  config.coherence.threshold = 1;
  for (const Point& p : before.points) {
    if (p.coherent) config.coherence.threshold = std::min(config.coherence.threshold, p.probability);
  }
  const Detection after = detect(cloud, config);
  CHECK(config.coherence.threshold < 1);
  for (const Point& p : after.points) {
    if (p.probability == config.coherence.threshold) CHECK(!p.coherent);
  }
}

TEST_CASE("edges are eligible strictly below both thresholds, and taken by weight and ids") {
  const Cloud cloud = plane(16).punched({8, 8}, 3);
  const Detection before = detect(cloud);
  REQUIRE(before.eligible.size() > 20);
  const auto prob_weight = [&](const Edge& edge) {
    return 2 - before.points[index(edge.low)].probability - before.points[index(edge.high)].probability;
  };
  std::size_t ties = 0;
  for (std::size_t i = 0; i < before.eligible.size(); ++i) {
    const Edge& edge = before.eligible[i];
    CHECK(edge.low < edge.high);
    CHECK(edge.weight * 0x1p24 == std::floor(edge.weight * 0x1p24));
    if (i == 0) continue;
    const Edge& last = before.eligible[i - 1];
    ties += last.weight == edge.weight;
    CHECK(std::tie(last.weight, last.low, last.high) < std::tie(edge.weight, edge.low, edge.high));
  }
  CHECK(ties > 0);

  const Edge& middle = before.eligible[before.eligible.size() / 2];
  Config by_prob, by_total;
  by_prob.spanning.max_prob_weight = prob_weight(middle);
  by_total.spanning.max_total_weight = middle.weight;
  for (const Edge& edge : detect(cloud, by_prob).eligible) CHECK(prob_weight(edge) < prob_weight(middle));
  for (const Edge& edge : detect(cloud, by_total).eligible) CHECK(edge.weight < middle.weight);
}

TEST_CASE("e is rounded, not cut off") {
  CHECK(detect(line(2)).e == 4);  // K = 1: 2 sqrt(pi) = 3.54
}

TEST_CASE("an edge may close a loop of e + 1 edges, not one of e") {
  // A ring of points that each see their two neighbours only; sparse enough to be eligible all round.
  Config config;
  config.neighbourhood.k = 2;
  config.spanning.max_prob_weight = 3;
  const Cloud ring = open_cylinder(24, 1);
  config.spanning.e = 23;
  REQUIRE(detect(ring, config).loops.size() == 1);
  CHECK(detect(ring, config).loops[0].size() == 24);
  config.spanning.e = 24;
  CHECK(detect(ring, config).loops.empty());
}

TEST_CASE(
    "every edge of a loop is in the spanning graph, every loop is longer than e, starts at its smallest id") {
  for (std::uint64_t seed = 300; seed < 340; ++seed) {
    INFO("seed " << seed);
    const Cloud cloud = random_cloud(seed);
    const Detection result = detect(cloud, random_config(seed, typical_spacing(cloud)));
    std::set<std::pair<PointId, PointId>> edges;
    for (const Edge& edge : result.spanning) edges.emplace(edge.low, edge.high);
    CHECK(std::is_sorted(result.loops.begin(), result.loops.end()));
    for (const auto& loop : result.loops) {
      CHECK(std::int64_t(loop.size()) > result.e);
      CHECK(*std::min_element(loop.begin(), loop.end()) == loop.front());
      CHECK(loop[1] < loop.back());
      CHECK(std::set(loop.begin(), loop.end()).size() == loop.size());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        CHECK(edges.contains(std::minmax(loop[i], loop[(i + 1) % loop.size()])));
      }
    }
  }
}

}  // namespace lacuna
