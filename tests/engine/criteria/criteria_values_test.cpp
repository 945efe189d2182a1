// SPDX-License-Identifier: Apache-2.0
// The criteria of batches: the same bits from every instruction set, and from every place in a batch.
#include "engine/criteria/criteria_values.hpp"

#include "engine/criteria/exact_fallback.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

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
  for (std::size_t i = 0; i < kBatchSize; ++i) points.push_back(drawn_neighbourhood(random));
  return points;
}

struct FilledBatch {
  std::vector<Batch<double>> rows;
  NeighbourBatch batch;
};

FilledBatch batch_of(const std::vector<Neighbourhood>& points, bool given) {
  std::size_t count = 0;
  for (const Neighbourhood& offsets : points) count = std::max(count, offsets.size());
  FilledBatch filled{.rows = std::vector<Batch<double>>(5 * count)};
  Batch<double>* const rows = filled.rows.data();
  NeighbourBatch& batch = filled.batch;
  batch.ranks = count;
  batch.x = rows, batch.y = rows + count, batch.z = rows + 2 * count;
  batch.squared_distance = rows + 3 * count, batch.weight = rows + 4 * count;
  for (std::size_t point = 0; point < kBatchSize; ++point) {
    batch.counts.at[point] = double(points[point].size());
    for (int axis = 0; axis < 3; ++axis)
      batch.given_normals[axis].at[point] = given ? (axis == 2 ? 1 : 0) : std::nan("");
    for (std::size_t i = 0; i < points[point].size(); ++i) {
      batch.x[i].at[point] = points[point][i].x();
      batch.y[i].at[point] = points[point][i].y();
      batch.z[i].at[point] = points[point][i].z();
      batch.squared_distance[i].at[point] = points[point][i].squaredNorm();
      batch.mean_distance.at[point] += points[point][i].norm() / double(points[point].size());
    }
  }
  return filled;
}

const CriteriaParameters kParameters{.sigma = 1,
                                     .cos_cone = 0.96,
                                     .crease_threshold = 0.5,
                                     .shares = {0.5, 0.25, 0.25},
                                     .uses_normals_off = true};

CriteriaValues evaluated(const std::vector<Neighbourhood>& points, bool given = false) {
  const FilledBatch filled = batch_of(points, given);
  CriteriaValues values{};
  evaluate_criteria(filled.batch, kParameters, values);
  return values;
}

// All that is said of one point.
std::vector<double> of_point(const CriteriaValues& of, std::size_t point) {
  static_assert(sizeof(CriteriaValues) % sizeof(Batch<double>) == 0);
  const auto* const rows = reinterpret_cast<const Batch<double>*>(&of);
  std::vector<double> values;
  for (std::size_t i = 0; i < sizeof(CriteriaValues) / sizeof(Batch<double>); ++i)
    values.push_back(rows[i].at[point]);
  return values;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
           return std::memcmp(&x, &y, sizeof x) == 0 || (std::isnan(x) && std::isnan(y));
         });
}

}  // namespace

TEST_CASE("every instruction set evaluates the criteria with the same bits") {
  Random random(11);
  std::size_t different = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Neighbourhood> points = drawn_neighbourhoods(random);
    const CriteriaValues expected = evaluated(points, round % 8 == 0);
    by_each_instruction_set([&] {
      const CriteriaValues found = evaluated(points, round % 8 == 0);
      for (std::size_t i = 0; i < kBatchSize; ++i)
        different += !same_bits(of_point(found, i), of_point(expected, i));
    });
  }
  CHECK(different == 0);
}

TEST_CASE("a point has the same values wherever it is in a batch, and whatever the other points are") {
  Random random(12);
  std::size_t different = 0;
  for (int round = 0; round < 300; ++round) {
    const Neighbourhood point = drawn_neighbourhood(random);
    const std::vector<double> alone = of_point(evaluated(std::vector<Neighbourhood>(kBatchSize, point)), 0);
    for (std::size_t place = 0; place < kBatchSize; ++place) {
      std::vector<Neighbourhood> points = drawn_neighbourhoods(random);
      points[place] = point;
      different += !same_bits(of_point(evaluated(points), place), alone);
    }
  }
  CHECK(different == 0);
}

TEST_CASE("directions sorted side by side have the gap of the exact fallback") {
  Random random(13);
  for (int round = 0; round < 500; ++round) {
    const std::vector<Neighbourhood> points = drawn_neighbourhoods(random);
    const FilledBatch filled = batch_of(points, true);
    CriteriaValues found;
    evaluate_criteria(filled.batch, kParameters, found);
    const double up[3] = {0, 0, 1};
    for (std::size_t i = 0; i < kBatchSize; ++i) {
      const LargestGap expected = find_largest_gap_exactly(filled.batch, i, up, kParameters.cos_cone);
      CHECK(found.gap_near.at[i] == expected.near);
      CHECK(found.gap_far.at[i] == expected.far);
    }
  }
}

// What is ambiguous in single precision: gaps of nearly one size, directions side by side, neighbours at the
// edge of the cone.
TEST_CASE("gaps that differ by nearly nothing are those of the exact fallback") {
  Random random(14);
  const double kTurn = 2 * std::numbers::pi, up[3] = {0, 0, 1};
  std::size_t different = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Neighbourhood> points(kBatchSize);
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
    const FilledBatch filled = batch_of(points, true);
    CriteriaValues found;
    evaluate_criteria(filled.batch, kParameters, found);
    for (std::size_t i = 0; i < kBatchSize; ++i) {
      const LargestGap expected = find_largest_gap_exactly(filled.batch, i, up, kParameters.cos_cone);
      const double even = kTurn / expected.used;
      const double angle =
          expected.used < 3 ? 1 : std::clamp((expected.size - even) / (kTurn / 2 - even), 0.0, 1.0);
      different += found.gap_near.at[i] != expected.near || found.gap_far.at[i] != expected.far ||
                   std::abs(found.criteria[0].at[i] - angle) > 1e-11;
    }
  }
  CHECK(different == 0);
}

}  // namespace lacuna
