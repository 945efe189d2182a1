// SPDX-License-Identifier: Apache-2.0
// Offsets gathered side by side, the criteria of batches with the same bits from every instruction set, and
// the evaluation of points.
#include "engine/criteria/criteria.hpp"

#include "engine/criteria/criteria_values.hpp"
#include "engine/criteria/exact_fallback.hpp"
#include "engine/criteria/neighbour_batch.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {

// ---- Offsets of neighbours
// The last position is the last there is: nothing is read beyond it (valgrind would report it).
TEST_CASE("a row has the offsets of as many neighbours as there are points, and 0 where there are no more") {
  Random random(8);
  std::size_t wrong = 0;
  for (int round = 0; round < 200; ++round) {
    const auto points = std::size_t(random.whole(1, 50));
    std::vector<double> positions(3 * points);
    for (double& coordinate : positions) coordinate = random.uniform(-1, 1);
    std::vector<std::vector<LocalIndex>> neighbours(kBatchSize);
    NeighbourLists of{.positions = positions.data(), .points = {}, .neighbours = {}, .counts = {}};
    std::size_t rows = 0;
    for (std::size_t i = 0; i < kBatchSize; ++i) {
      const auto drawn = [&] { return LocalIndex(random.whole(0, std::int64_t(points) - 1)); };
      neighbours[i].resize(std::size_t(random.whole(1, 20)));
      std::generate(neighbours[i].begin(), neighbours[i].end(), drawn);
      of.points[i] = drawn();
      of.neighbours[i] = neighbours[i].data();
      of.counts[i] = std::uint32_t(neighbours[i].size());
      rows = std::max(rows, neighbours[i].size());
    }
    by_each_instruction_set([&] {
      std::vector<Batch<double>> columns(4 * rows);
      NeighbourBatch batch{.ranks = rows, .x = &columns[0], .y = &columns[rows], .z = &columns[2 * rows]};
      batch.squared_distance = &columns[3 * rows];
      gather_neighbours(of, batch);
      for (std::size_t i = 0; i < kBatchSize; ++i) {
        double sum = 0;
        for (std::size_t row = 0; row < rows; ++row) {
          const bool is_there = row < neighbours[i].size();
          double squared = 0;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const double expected =
                is_there ? positions[3 * neighbours[i][row] + axis] - positions[3 * of.points[i] + axis] : 0;
            wrong += columns[axis * rows + row].at[i] != expected;
            squared += expected * expected;
          }
          wrong += columns[3 * rows + row].at[i] != squared;
          sum += std::sqrt(squared);
        }
        wrong += batch.mean_distance.at[i] != sum / double(neighbours[i].size());
      }
    });
  }
  CHECK(wrong == 0);
}

namespace {

// ---- Batches

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

// ---- Points

// The evaluation of a point with its criteria.
struct Evaluated : Evaluation {
  std::array<double, 3> criteria;
};

// Evaluates the first of distinct points in one tile.
Evaluated evaluate_first(const Cloud& cloud, const Config& config = {}) {
  TilePoints points{.owned = static_cast<LocalIndex>(cloud.size()), .positions = cloud.positions};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points.ids.push_back(PointId{i});
    points.rows.push_back(Row{i});
    points.linked.offsets.push_back(0);
  }
  const auto k = static_cast<std::size_t>(config.neighbourhood.k);
  std::vector<double> values(cloud.size() * criteria().size(), -1);
  const std::vector<Evaluation> all = evaluate(points, find_neighbourhoods(points, k, 0), cloud.normals,
                                               config.normals, config.criteria, values);
  return {all[0], {values[0], values[1], values[2]}};
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
