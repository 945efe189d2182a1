// SPDX-License-Identifier: Apache-2.0
// Points far from all others: the rule, against itself done plainly, and that no tiling changes the answer.
#include "engine/bucket/strays.hpp"

#include "tests/support/detected.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

const Eigen::Vector3d kUtm(500'000, 5'400'000, 300);

Cloud cloud_of(std::vector<Eigen::Vector3d> positions) {
  return {std::move(positions), {}};
}

Strays strays_of(const Cloud& cloud, const Config& config = {}) {
  const TiledScan scan(cloud, config);
  return find_strays(scan.store);
}

// The rule, with sorts.
Strays found_plainly(const Cloud& cloud) {
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::set<Eigen::Vector3d, decltype(before)> distinct(before);
  for (const Eigen::Vector3d& p : cloud.positions)
    if (p.allFinite()) distinct.insert(p);
  Strays strays;
  for (const Eigen::Vector3d& p : distinct) strays.rest.extend(p);
  if (distinct.size() < kFewestPoints) return strays;
  const std::size_t passed_over = std::clamp<std::size_t>(distinct.size() / 1024, 1, 1024);
  Eigen::AlignedBox3d near;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : distinct) values.push_back(p[axis]);
    std::sort(values.begin(), values.end());
    near.min()[axis] = values[passed_over];
    near.max()[axis] = values[values.size() - 1 - passed_over];
  }
  const double grown = kFarFromRest * near.sizes().maxCoeff();
  if (grown == 0) return strays;
  near.min().array() -= grown;
  near.max().array() += grown;
  strays.rest.setEmpty();
  for (const Eigen::Vector3d& p : distinct) {
    if (near.contains(p)) {
      strays.rest.extend(p);
    } else {
      ++strays.points;
    }
  }
  return strays;
}

TEST_CASE("returns at 0 0 0 in a scan of map coordinates are one stray, and the rest has its own bounds") {
  const Cloud scan = plane(40).translated(kUtm);
  const Cloud returns = cloud_of(std::vector<Eigen::Vector3d>(500, Eigen::Vector3d::Zero()));
  const Strays strays = strays_of(returns.joined(scan));
  CHECK(strays.points == 1);
  CHECK(strays.has_origin);
  CHECK(strays.example == Eigen::Vector3d::Zero());
  CHECK(strays.rest.min() == kUtm);
  CHECK(strays.rest.max() == kUtm + Eigen::Vector3d(39, 39, 0));
}

TEST_CASE("the example is the stray of the lowest id, on whichever side it lies") {
  const Strays strays = strays_of(plane(60).joined(cloud_of({{9000, 0, 0}, {0, 0, -5000}})));
  CHECK(strays.points == 2);
  CHECK_FALSE(strays.has_origin);
  CHECK(strays.example == Eigen::Vector3d(9000, 0, 0));
  CHECK(strays.rest.max() == Eigen::Vector3d(59, 59, 0));
}

TEST_CASE("strays are those of the rule done plainly, for every tiling") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Cloud cloud = random_cloud(seed).with_outliers(seed % 4, 20, seed);
    const Strays plain = found_plainly(cloud);
    INFO("seed " << seed);
    for (const std::int64_t tile_points : {0, 100, 700}) {
      const Strays found = strays_of(cloud, tiled({}, tile_points));
      CHECK(found.points == plain.points);
      if (plain.rest.isEmpty()) continue;
      CHECK(found.rest.min() == plain.rest.min());
      CHECK(found.rest.max() == plain.rest.max());
    }
  }
}

TEST_CASE("a stray changes the mean distance of neighbours, and hardly the median") {
  const Cloud scan = plane(40).jittered(0.1, 1);
  const Summary clean = run_engine(scan, {}).summary;
  const Summary with_stray = run_engine(scan.joined(cloud_of({{1e5, 0, 0}})), {}).summary;
  CHECK(clean.median_distance == Approx(clean.mean_edge_length).epsilon(0.1));
  CHECK(with_stray.median_distance == Approx(clean.median_distance).epsilon(0.01));
  CHECK(with_stray.mean_edge_length > 10 * clean.mean_edge_length);
}

}  // namespace
}  // namespace lacuna
