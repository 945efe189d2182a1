// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluate.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/tile.hpp"

namespace lacuna {
namespace {

// The evaluation of a point with its criteria.
struct Evaluated : Evaluation {
  std::array<double, 3> criteria;
};

std::vector<Evaluated> evaluate_whole(const Cloud& cloud, const TilePoints& points, const Config& config,
                                      double eps) {
  const Neighbourhoods rows =
      find_neighbourhoods(points, static_cast<std::size_t>(config.neighbourhood.k), eps);
  std::vector<double> values(points.owned * criteria().size(), -1);
  std::vector<Evaluated> all;
  for (const Evaluation& e :
       evaluate(points, rows, owned_normals(cloud, points), config.normals, config.criteria, values)) {
    all.push_back({e, {}});
    std::copy_n(&values[(all.size() - 1) * criteria().size()], 3, all.back().criteria.begin());
  }
  return all;
}

Evaluated evaluate_first(const Cloud& cloud, const Config& config = {}) {
  const TilePoints points = whole_tile(cloud);
  return evaluate_whole(cloud, points, config, config.neighbourhood.eps)[row_of(points, PointId{0})];
}

bool near(double a, double b) {
  return std::abs(a - b) <= 1e-9;
}

TEST_CASE("probabilities are those of the plain method to 1e-9, gap neighbours and distances the same") {
  std::size_t compared = 0, ill_conditioned = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Cloud cloud = random_cloud(2000 + seed);
    Config config = random_config(2000 + seed, typical_spacing(cloud));
    config.normals.orient = false;
    config.spanning = {.max_prob_weight = 1e-9};
    const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
    const TilePoints points = whole_tile(cloud);
    const std::vector<Evaluated> evaluations = evaluate_whole(cloud, points, config, plain.eps);
    std::size_t wrong_criteria = 0, wrong_distance = 0, wrong_gap = 0, wrong_rounding = 0;
    for (LocalIndex i = 0; i < points.owned; ++i) {
      const Evaluated& e = evaluations[i];
      const reference::Point& p = plain.points[value(points.ids[i])];
      ++compared;
      wrong_distance += e.mean_distance != p.mean_distance;
      const bool given = !cloud.normals.empty();
      if (p.turned_by_rounding) continue;
      if (!given && p.lambda[1] - p.lambda[2] <= 1e-9) {
        ++ill_conditioned;
        continue;
      }
      wrong_criteria +=
          !near(e.criteria[0], p.angle) || !near(e.criteria[1], p.halfdisc) || !near(e.criteria[2], p.shape);
      wrong_rounding += std::abs(e.probability - p.combined) > kProbabilityStep / 2 + 1e-9;
      const bool has_gap = e.gap_near != kNoIndex;
      wrong_gap +=
          has_gap != p.gap.has_value() ||
          (has_gap && (points.ids[e.gap_near] != (*p.gap)[0] || points.ids[e.gap_far] != (*p.gap)[1]));
    }
    INFO("seed " << seed);
    CHECK(wrong_criteria == 0);
    CHECK(wrong_distance == 0);
    CHECK(wrong_gap == 0);
    CHECK(wrong_rounding == 0);
  }
  INFO(ill_conditioned << " of " << compared << " points have no well defined normal");
  CHECK(ill_conditioned < compared / 5);
}

TEST_CASE("inside of a plane nothing speaks for a boundary, at its edge everything does") {
  const Cloud inner = plane(9).translated({-4, -4, 0});
  Cloud cloud;
  cloud.positions = {{0, 0, 0}};
  for (const Eigen::Vector3d& p : inner.positions)
    if (p.norm() > 0) cloud.positions.push_back(p);
  Config config;
  config.neighbourhood.k = 8;
  const Evaluated inside = evaluate_first(cloud, config);
  CHECK(inside.criteria[0] == Approx(0).margin(1e-12));
  CHECK(inside.criteria[1] == Approx(0).margin(1e-12));
  CHECK(inside.mean_distance == Approx((1 + std::sqrt(2.0)) / 2));
  CHECK(std::abs(inside.normal.z()) == Approx(1));

  Cloud half;
  for (const Eigen::Vector3d& p : cloud.positions)
    if (p.x() >= 0) half.positions.push_back(p);
  const Evaluated edge = evaluate_first(half, config);
  CHECK(edge.criteria[0] == Approx(1));
  CHECK(edge.criteria[1] > 0.8);
  CHECK(edge.criteria[2] > inside.criteria[2]);
  CHECK(edge.probability > inside.probability + 0.5);
  CHECK(edge.mean_offset.x() > 0.5);
}

TEST_CASE("a given normal is used, normalised, and a zero one is estimated") {
  Cloud cloud = plane(9);
  cloud.normals.assign(cloud.size(), {0, 30, 40});
  CHECK((evaluate_first(cloud).normal - Eigen::Vector3d(0, 0.6, 0.8)).norm() < 1e-15);
  cloud.normals.assign(cloud.size(), {0, 0, 0});
  CHECK(std::abs(evaluate_first(cloud).normal.z()) == Approx(1));
  cloud.normals.assign(cloud.size(), {0, 3e-200, 4e-200});
  CHECK((evaluate_first(cloud).normal - Eigen::Vector3d(0, 0.6, 0.8)).norm() < 1e-15);
}

TEST_CASE("probabilities are rounded to multiples of 2^-24, ties to even") {
  const double step = std::ldexp(1.0, -24);
  CHECK(round_to_step(0.5 + 0.4 * step) == 0.5);
  CHECK(round_to_step(0.5 + 0.5 * step) == 0.5);
  CHECK(round_to_step(0.5 + 1.5 * step) == 0.5 + 2 * step);
  CHECK(double(float(round_to_step(1.0 / 3))) == round_to_step(1.0 / 3));
}

}  // namespace
}  // namespace lacuna
