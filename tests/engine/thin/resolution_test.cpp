// Which resolution a scan has, from the sample of a few points to whole scans.
#include "engine/thin/choose_resolution.hpp"
#include "engine/thin/local_sampling.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/tiled_scan.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

// Offsets from the first point to its nearest others.
LocalSampling sampling_of(const Cloud& cloud, std::size_t at) {
  std::vector<Eigen::Vector3d> offsets;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i != at) offsets.push_back(cloud.positions[i] - cloud.positions[at]);
  }
  std::sort(offsets.begin(), offsets.end(),
            [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  offsets.resize(std::min(offsets.size(), kSamplingNeighbours));
  return *measure_sampling(offsets);
}

// Lines along x with the given distance, and points along them one apart.
Cloud lines(int count, int length, double distance) {
  Cloud cloud;
  for (int y = 0; y < count; ++y) {
    for (int x = 0; x < length; ++x) cloud.positions.emplace_back(x, distance * y, 0);
  }
  return cloud;
}

double resolution(const Cloud& cloud, std::int64_t tile_points = 2000) {
  TiledScan scan(cloud, tiled({}, tile_points));
  return choose_resolution(scan.store, scan.job);
}

TEST_CASE("the sampling of a grid, of lines and at a border") {
  const Eigen::Vector3d axis(1, 2, 3);
  const Cloud grid = plane(21).jittered(0.1, 1).rotated(axis, 40);
  CHECK(sampling_of(grid, 220).spacing == Approx(1.1).margin(0.15));
  CHECK(sampling_of(grid, 220).line_distance == Approx(1.2).margin(0.3));
  const Cloud rows = lines(21, 201, 5).jittered(0.2, 1).noisy(0.2, 2).rotated(axis, 40);
  const LocalSampling in_line = sampling_of(rows, 10 * 201 + 100);
  CHECK(in_line.spacing == Approx(2).margin(0.3));
  CHECK(in_line.line_distance == Approx(5.2).margin(0.4));
  // No point on the other side: the distance of the last neighbour.
  CHECK(sampling_of(grid, 10).line_distance > 3);
}

TEST_CASE("fewer neighbours than are needed have no sampling") {
  CHECK_FALSE(measure_sampling(std::vector(kSamplingNeighbours - 1, Eigen::Vector3d(1, 0, 0))));
}

TEST_CASE("a resolution needs enough points in lines, and is the distance of most of their lines") {
  const LocalSampling even{1, 1.2}, line{1, 3.14}, dense{0.2, 0.25}, dense_line{0.2, 0.77};
  const auto mixed = [](std::vector<std::pair<int, LocalSampling>> parts) {
    std::vector<LocalSampling> sample;
    for (const auto& [count, sampling] : parts) sample.insert(sample.end(), count, sampling);
    return resolution_of(sample);
  };
  CHECK(mixed({}) == 0);
  CHECK(mixed({{100, even}}) == 0);
  CHECK(mixed({{71, even}, {29, line}}) == 0);
  CHECK(mixed({{70, even}, {30, line}}) == 3);
  CHECK(mixed({{96, even}, {4, dense_line}}) == 0);
  CHECK(mixed({{94, even}, {6, dense_line}}) == 0.8);
  CHECK(mixed({{90, even}, {8, dense}, {2, dense_line}}) == 0);
  CHECK(mixed({{50, line}, {50, {1, 8.9}}}) == 9);
  CHECK(mixed({{61, line}, {39, {1, 8.9}}}) == 3);
}

TEST_CASE("even scans, noisy ones and scans of few points have no resolution") {
  CHECK(resolution(plane(80).jittered(0.3, 1).punched({40, 40}, 10)) == 0);
  CHECK(resolution(scattered(6000, 1).scaled(100).noisy(0.5, 1)) == 0);
  CHECK(resolution(density_step(100).jittered(0.2, 1)) == 0);
  CHECK(resolution(lines(9, 100, 5)) == 0);
}

TEST_CASE("the resolution of a scan of lines is their distance, whatever tiles and order") {
  const Cloud cloud = lines(40, 400, 5.2).jittered(0.3, 1).noisy(0.1, 2);
  CHECK(resolution(cloud) == 5);
  CHECK(resolution(cloud.shuffled(1)) == 5);
  CHECK(resolution(cloud, 100) == 5);
  CHECK(resolution(cloud.rotated({3, 1, 2}, 50).translated({500'000, 5'400'000, 300})) == 5);
}

}  // namespace
}  // namespace lacuna
