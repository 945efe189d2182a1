// Points judged side by side: the same bits from every instruction set, and from every place in a bundle.
#include "engine/criteria/judge.hpp"

#include "engine/criteria/criterion.hpp"
#include "engine/criteria/largest_gaps.hpp"
#include "tests/support/clouds.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>
#include <Eigen/Core>

namespace lacuna {
namespace {

using Neighbourhood = std::vector<Eigen::Vector3d>;  // offsets, nearest first

// A bumpy plane, half of one, a line, a crease, a lattice with its exact ties, or points all around.
Neighbourhood drawn_neighbourhood(Random& random) {
  const auto count = std::size_t(random.whole(1, random.chance(0.2) ? 90 : 30));
  const std::int64_t kind = random.whole(0, 5);
  Neighbourhood offsets;
  while (offsets.size() < count) {
    Eigen::Vector3d q(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.1, 0.1));
    if (kind == 1) q.x() = std::abs(q.x());
    if (kind == 2) q = Eigen::Vector3d(q.x(), 2 * q.x(), 0);
    if (kind == 3) q.z() = std::abs(q.x());
    if (kind == 4) q = Eigen::Vector3d(std::round(6 * q.x()), std::round(6 * q.y()), 0);
    if (kind == 5) q.z() *= 10;
    if (q.norm() > 0) offsets.push_back(q);
  }
  std::sort(offsets.begin(), offsets.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  return offsets;
}

std::vector<Neighbourhood> drawn_neighbourhoods(Random& random) {
  std::vector<Neighbourhood> points;
  for (std::size_t i = 0; i < kBundle; ++i) points.push_back(drawn_neighbourhood(random));
  return points;
}

struct FilledBundle {
  std::vector<Eight> rows;
  Bundle bundle;
};

FilledBundle bundle_of(const std::vector<Neighbourhood>& points, bool given) {
  std::size_t count = 0;
  for (const Neighbourhood& offsets : points) count = std::max(count, offsets.size());
  FilledBundle filled{.rows = std::vector<Eight>(5 * count)};
  Eight* const rows = filled.rows.data();
  Bundle& bundle = filled.bundle;
  bundle.rows = count;
  bundle.x = rows, bundle.y = rows + count, bundle.z = rows + 2 * count;
  bundle.squared_distance = rows + 3 * count, bundle.weight = rows + 4 * count;
  for (std::size_t point = 0; point < kBundle; ++point) {
    bundle.counts.at[point] = double(points[point].size());
    for (int axis = 0; axis < 3; ++axis)
      bundle.given_normals[axis].at[point] = given ? (axis == 2 ? 1 : 0) : std::nan("");
    for (std::size_t i = 0; i < points[point].size(); ++i) {
      bundle.x[i].at[point] = points[point][i].x();
      bundle.y[i].at[point] = points[point][i].y();
      bundle.z[i].at[point] = points[point][i].z();
      bundle.squared_distance[i].at[point] = points[point][i].squaredNorm();
      bundle.mean_distance.at[point] += points[point][i].norm() / double(points[point].size());
    }
  }
  return filled;
}

const JudgeParameters kParameters{
    .sigma = 1, .cos_cone = 0.96, .crease_threshold = 0.5, .shares = {0.5, 0.25, 0.25}};

Judgements judged(Judge* judge, const std::vector<Neighbourhood>& points, bool given = false) {
  const FilledBundle filled = bundle_of(points, given);
  Judgements judgements;
  judge(filled.bundle, kParameters, judgements);
  return judgements;
}

// All that is said of one point.
std::vector<double> of_point(const Judgements& judgements, std::size_t point) {
  static_assert(sizeof(Judgements) % sizeof(Eight) == 0);
  const auto* const rows = reinterpret_cast<const Eight*>(&judgements);
  std::vector<double> values;
  for (std::size_t i = 0; i < sizeof(Judgements) / sizeof(Eight); ++i) values.push_back(rows[i].at[point]);
  return values;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
           return std::memcmp(&x, &y, sizeof x) == 0 || (std::isnan(x) && std::isnan(y));
         });
}

std::vector<Judge*> available_sets() {
  std::vector<Judge*> sets{plain::judge};
#if defined(__x86_64__) && !defined(LACUNA_PORTABLE)
  if (__builtin_cpu_supports("x86-64-v3")) sets.push_back(v3::judge);
  if (__builtin_cpu_supports("x86-64-v4")) sets.push_back(v4::judge);
#endif
  return sets;
}

}  // namespace

TEST_CASE("every instruction set judges with the same bits") {
  Random random(11);
  std::size_t different = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Neighbourhood> points = drawn_neighbourhoods(random);
    const Judgements expected = judged(plain::judge, points, round % 8 == 0);
    for (Judge* const judge : available_sets()) {
      const Judgements found = judged(judge, points, round % 8 == 0);
      for (std::size_t i = 0; i < kBundle; ++i)
        different += !same_bits(of_point(found, i), of_point(expected, i));
    }
  }
  CHECK(different == 0);
}

TEST_CASE("a point is judged alike wherever it stands in a bundle, and whatever stands beside it") {
  Random random(12);
  std::size_t different = 0;
  for (int round = 0; round < 300; ++round) {
    const Neighbourhood point = drawn_neighbourhood(random);
    const std::vector<double> alone =
        of_point(judged(fastest::judge, std::vector<Neighbourhood>(kBundle, point)), 0);
    for (std::size_t place = 0; place < kBundle; ++place) {
      std::vector<Neighbourhood> points = drawn_neighbourhoods(random);
      points[place] = point;
      different += !same_bits(of_point(judged(fastest::judge, points), place), alone);
    }
  }
  CHECK(different == 0);
}

TEST_CASE("directions sorted side by side have the gap that is found with care") {
  Random random(13);
  std::size_t compared = 0;
  for (int round = 0; round < 500; ++round) {
    const std::vector<Neighbourhood> points = drawn_neighbourhoods(random);
    const FilledBundle filled = bundle_of(points, true);
    Judgements found;
    fastest::judge(filled.bundle, kParameters, found);
    const double up[3] = {0, 0, 1};
    for (std::size_t i = 0; i < kBundle; ++i) {
      const GapFit expected = largest_gap_carefully(filled.bundle, i, up, kParameters.cos_cone);
      ++compared;
      CHECK(found.gap_near.at[i] == expected.near);
      CHECK(found.gap_far.at[i] == expected.far);
    }
  }
  CHECK(compared == 500 * kBundle);
}

// What single precision cannot tell: gaps of nearly one size, directions side by side, neighbours at the edge
// of the cone.
TEST_CASE("gaps that differ by nearly nothing are told apart as with care") {
  Random random(14);
  const double kTurn = 2 * std::numbers::pi, up[3] = {0, 0, 1};
  std::size_t different = 0, compared = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Neighbourhood> points(kBundle);
    for (Neighbourhood& offsets : points) {
      const double little = std::pow(10, random.uniform(-12, -3)), start = random.uniform(0, kTurn);
      const auto count = random.whole(3, 20);
      for (std::int64_t i = 0; i < count; ++i) {
        // Even directions but for little; every third one nearly that of the one before; heights near the
        // cone's.
        const double place =
            double(random.chance(0.3) ? std::max<std::int64_t>(i, 1) - 1 : i) / double(count);
        const double angle = start + kTurn * place + little * random.uniform(-1, 1);
        const double height = random.chance(0.5) ? 0 : kParameters.cos_cone + little * random.uniform(-1, 1);
        const double flat = std::sqrt(1 - height * height);
        const double length = 1 + 0.01 * double(i);
        offsets.emplace_back(length * flat * std::cos(angle), length * flat * std::sin(angle),
                             length * height);
      }
    }
    const FilledBundle filled = bundle_of(points, true);
    Judgements found;
    fastest::judge(filled.bundle, kParameters, found);
    for (std::size_t i = 0; i < kBundle; ++i) {
      const GapFit expected = largest_gap_carefully(filled.bundle, i, up, kParameters.cos_cone);
      const double even = kTurn / expected.used;
      const double angle =
          expected.used < 3 ? 1 : std::clamp((expected.size - even) / (kTurn / 2 - even), 0.0, 1.0);
      ++compared;
      different += found.gap_near.at[i] != expected.near || found.gap_far.at[i] != expected.far ||
                   std::abs(found.criteria[kAngle].at[i] - angle) > 1e-11;
    }
  }
  CHECK(compared == 4000 * kBundle);
  CHECK(different == 0);
}

}  // namespace lacuna
