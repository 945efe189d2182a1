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

}  // namespace

// ---- Neighbourhoods ----------------------------------------------------------------------------------

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
