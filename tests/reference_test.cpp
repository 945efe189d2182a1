// SPDX-License-Identifier: Apache-2.0
#include "tests/support/reference.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

using Eigen::Vector3d;
using reference::Detection;
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
    for (PointId q : result.distinct)
      if (p != q) row.emplace_back(squared_distance(cloud, index(p), index(q)), q);
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

void check_neighbours(const Cloud& cloud, const Config& config) {
  const Detection result = detect(cloud, config);
  const auto expected = brute_force_neighbours(cloud, result, config.neighbourhood.k);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) differing += result.points[i].neighbours != expected[i];
  CHECK(differing == 0);
}

}  // namespace

// ---- Neighbourhoods ----------------------------------------------------------------------------------

TEST_CASE("neighbours are those of a brute force search, in order, on random clouds") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    INFO("seed " << seed);
    const Cloud cloud = random_cloud(seed);
    if (cloud.size() > 1000) continue;
    check_neighbours(cloud, random_config(seed, typical_spacing(cloud)));
  }
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

// ---- Normals and criteria ----------------------------------------------------------------------------

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

TEST_CASE("a point at the threshold exactly is no candidate") {
  const Cloud cloud = open_cylinder(40, 12);
  const Detection before = detect(cloud);
  Config config;
  config.coherence.threshold = 1;
  for (const Point& p : before.points)
    if (p.coherent) config.coherence.threshold = std::min(config.coherence.threshold, p.probability);
  const Detection after = detect(cloud, config);
  CHECK(config.coherence.threshold < 1);
  for (const Point& p : after.points)
    if (p.probability == config.coherence.threshold) CHECK(!p.coherent);
}

TEST_CASE("e is rounded, not cut off") {
  CHECK(detect(line(2)).e == 4);  // K = 1: 2 sqrt(pi) = 3.54
}

}  // namespace lacuna
