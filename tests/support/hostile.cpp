// SPDX-License-Identifier: Apache-2.0
#include "tests/support/hostile.hpp"

#include "tests/support/test.hpp"

namespace lacuna {

Cloud rough_sheet(int n, std::uint64_t seed) {
  Cloud cloud = scattered(n, seed);
  for (Eigen::Vector3d& p : cloud.positions) p.z() = 0.05 * std::sin(9 * p.x());
  return cloud;
}

Cloud volume(int n, std::uint64_t seed) {
  Cloud cloud = scattered(n, seed);
  Random random(seed + 1);
  for (Eigen::Vector3d& p : cloud.positions) p.z() = random.uniform();
  return cloud;
}

Cloud cluster(int n, std::uint64_t seed) {
  const Cloud small = rough_sheet(n / 10 * 9, seed).scaled(1e-6).translated({0.5, 0.5, 0.1});
  return small.joined(rough_sheet(n / 10, seed + 1)).shuffled(seed);
}

Cloud volume_cluster(int n, std::uint64_t seed) {
  const Cloud small = volume(n / 10 * 9, seed).scaled(1e-6).translated({0.5, 0.5, 0.1});
  return small.joined(rough_sheet(n / 10, seed + 1));
}

Cloud log_uniform(int n, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (int i = 0; i < n; ++i) {
    const double distance = std::pow(10, random.uniform(-6, 0));
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    cloud.positions.emplace_back(distance * std::cos(angle), distance * std::sin(angle), 0);
  }
  return cloud;
}

Cloud random_line(int n, std::uint64_t seed) {
  Cloud cloud = scattered(n, seed);
  for (Eigen::Vector3d& p : cloud.positions) p.y() = 0;
  return cloud;
}

Cloud zeros(int n, std::uint64_t seed) {
  return rough_sheet(n / 25, seed).joined(coincident(n - n / 25)).shuffled(seed);
}

// Coordinates of outliers have Cauchy's distribution.
Cloud one_percent_far(int n, std::uint64_t seed) {
  Cloud cloud = rough_sheet(n, seed);
  Random random(seed + 1);
  const auto far = [&] { return 1e6 * std::tan(std::numbers::pi * (random.uniform() - 0.5)); };
  for (int i = 0; i < n / 100; ++i) {
    Eigen::Vector3d& p = cloud.positions[std::size_t(random.whole(0, n - 1))];
    p.x() = far();
    p.y() = far();
    p.z() = far();
  }
  return cloud;
}

}  // namespace lacuna
