// SPDX-License-Identifier: Apache-2.0
#include "io/stations/find_station.hpp"

#include "bench/synth/scan.hpp"
#include "bench/synth/scanner.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

// Points that follow each other on upright lines of a sweep, on posts before a wall.
std::vector<Eigen::Vector3d> sweep_of_posts(const Eigen::Vector3d& eye) {
  std::vector<Eigen::Vector3d> points;
  constexpr int kLines = 200, kRays = 100;
  for (int line = 0; line < kLines; ++line) {
    for (int ray = 0; ray < kRays; ++ray) {
      const double azimuth = 0.005 * line - 0.5, elevation = 0.005 * ray - 0.25;
      const bool is_post = (line / 10 + ray / 10) % 2 == 0;  // a board of squares before it
      const Eigen::Vector3d direction(std::cos(azimuth) * std::cos(elevation),
                                      std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
      points.push_back(eye + (is_post ? 3 : 10) / direction.x() * direction);
    }
  }
  return points;
}

Jumps jumps_of(std::span<const Eigen::Vector3d> points) {
  Jumps jumps;
  for (const Eigen::Vector3d& point : points) jumps.add(point);
  return jumps;
}

}  // namespace

TEST_CASE("the station of a sweep is where the jumps in range come from, anywhere on Earth") {
  for (const Eigen::Vector3d& eye : {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(500'000, 5'400'000, 300)}) {
    const Jumps jumps = jumps_of(sweep_of_posts(eye));
    const std::optional<FoundStation> found = find_station(jumps.jumps());
    REQUIRE(found);
    CHECK((found->place - eye).norm() < 0.01);
    CHECK(found->share > 0.9);
  }
}

TEST_CASE("points in another order than that of a sweep have no station") {
  std::vector<Eigen::Vector3d> points = sweep_of_posts({1, 2, 3});
  for (std::size_t i = 0; i < points.size(); ++i) std::swap(points[i], points[i * 7919 % points.size()]);
  const Jumps jumps = jumps_of(points);
  const std::optional<FoundStation> found = find_station(jumps.jumps());
  CHECK((!found || found->share < FoundStation::kLeastShare));
}

TEST_CASE("a smooth surface has no jumps, and gives no station") {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 10'000; ++i) points.push_back({0.01 * (i % 100), 0.01 * (i / 100), 0});
  CHECK(jumps_of(points).jumps().size() < 100);
  CHECK_FALSE(find_station(jumps_of(points).jumps()));
  CHECK_FALSE(find_station({}));
}

TEST_CASE("a ray without return interrupts a line: no jump leads across it") {
  Jumps jumps;
  for (int i = 0; i < 1000; ++i) {
    for (const double x : {0.0, 0.01, 0.02}) jumps.add({x + i, 0, 0});
    jumps.add(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  CHECK(jumps.jumps().empty());
}

TEST_CASE("no more than so many jumps stand for all") {
  Jumps jumps;
  for (int i = 0; i < 40'000; ++i)
    for (const double x : {0.0, 0.01}) jumps.add({x + i, 0, 0});
  CHECK(jumps.jumps().size() < Jumps::kMost);
  CHECK(jumps.jumps().size() >= Jumps::kMost / 2);
}

TEST_CASE("stations of a synthetic scan are found from its sweeps") {
  const ScratchFolder folder;
  synth::ScanOptions options;
  options.out = folder / "scan.ply";
  options.scene = synth::SceneKind::kPlant;
  options.points = 100'000;
  synth::write_scan(options);
  const synth::Scanner scanner(options, synth::make_scene(options.scene, options.seed));
  const ScanFiles scan({options.out}, {});
  const std::vector<Sweep> sweeps = read_sweeps(scan);
  REQUIRE(sweeps.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(sweeps[i].source == std::optional<std::uint32_t>(i));
    const std::optional<FoundStation> found = find_station(sweeps[i].jumps.jumps());
    REQUIRE(found);
    CHECK(found->share > FoundStation::kLeastShare);
    const auto [x, y, z] = scanner.stations()[i];
    CHECK((found->place - Eigen::Vector3d(x, y, z)).norm() < 0.05);
  }
}

}  // namespace lacuna::io
