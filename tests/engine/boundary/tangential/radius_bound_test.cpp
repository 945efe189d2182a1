// SPDX-License-Identifier: Apache-2.0
// Bounds on circumradii, from medians by hand, whatever points share the batch.
#include "engine/boundary/tangential/radius_bound.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna::tangential {
namespace {

constexpr TangentialConfig kConfig{
    .max_radius = 1.75, .hole_radius = 0.8125, .most_radius = 0.375, .coarse_bound = 3};

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

RadiusBound bound_by_hand(const std::vector<Sampling>& samplings, const PointAndNeighbours& around) {
  std::vector<double> medians, spreads;
  const auto add = [&](LocalIndex q) {
    if (samplings[q].median_radius == 0) return;
    medians.push_back(samplings[q].median_radius);
    spreads.push_back(samplings[q].spread);
  };
  add(around.point);
  for (const LocalIndex q : around.neighbours) add(q);
  const double most = kConfig.most_radius * samplings[around.point].distance;
  const double median_radius = medians.empty() ? most : std::min(median(medians), most);
  const double spread = medians.empty() ? most : std::min(median(spreads), most);
  const double distance = samplings[around.point].distance;
  const double fine = (kConfig.max_radius * median_radius + spread) / distance;
  return {static_cast<float>(fine), static_cast<float>(3 * fine)};
}

}  // namespace

TEST_CASE("samplings of stars side by side are those of each alone") {
  Random random(3);
  std::size_t wrong = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::vector<LinkVertex<LocalIndex>>> link(std::size_t(random.whole(1, kBatchSize)));
    std::vector<FoundStar> stars;
    for (auto& of_one : link) {
      of_one.resize(std::size_t(random.chance(0.1) ? random.whole(0, 64) : random.whole(3, 9)));
      for (auto& vertex : of_one)
        vertex = {0, static_cast<float>(random.chance(0.8) ? random.uniform(0.1, 1) : 8)};
      stars.emplace_back(of_one.data(), 1, of_one.size(), random.uniform(1, 2));
    }
    const auto together = samplings_of(stars, kConfig);
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const Sampling alone = samplings_of({&stars[i], 1}, kConfig)[0];
      wrong += together[i].distance != alone.distance || together[i].median_radius != alone.median_radius ||
               together[i].spread != alone.spread;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("bounds are those by hand, bit for bit, whatever points share the batch") {
  Random random(5);
  std::size_t wrong = 0, most = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Sampling> samplings(200);
    for (Sampling& s : samplings) {
      if (random.chance(0.8)) s = {random.uniform(0.5, 2), random.uniform(0.1, 2), random.uniform(0, 1)};
      if (random.chance(0.2)) s.median_radius = s.spread = 0;  // large triangles only
    }
    std::vector<std::vector<LocalIndex>> neighbours;
    std::vector<PointAndNeighbours> all;
    const auto points = static_cast<std::size_t>(random.whole(1, 20));
    for (std::size_t i = 0; i < points; ++i) {
      auto p = static_cast<LocalIndex>(random.whole(0, 199));
      while (samplings[p].distance == 0) p = (p + 1) % 200;
      const auto count = static_cast<std::size_t>(random.whole(0, random.chance(0.05) ? 180 : 30));
      neighbours.emplace_back();
      while (neighbours.back().size() < count)
        neighbours.back().push_back(static_cast<LocalIndex>(random.whole(0, 199)));
      most = std::max(most, count);
      all.push_back({p, {}});
    }
    for (std::size_t i = 0; i < points; ++i) all[i].neighbours = neighbours[i];
    std::size_t bounded = 0;
    RadiusBounder(samplings, kConfig)
        .for_each(
            points, [&](std::size_t i) { return all[i]; },
            [&](std::size_t i, const RadiusBound& bound) {
              const RadiusBound expected = bound_by_hand(samplings, all[i]);
              wrong += i != bounded++ || bound.fine != expected.fine || bound.coarse != expected.coarse;
            });
    CHECK(bounded == points);
  }
  CHECK(wrong == 0);
  CHECK(most > 128);
}

}  // namespace lacuna::tangential
