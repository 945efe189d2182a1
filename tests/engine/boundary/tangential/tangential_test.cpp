// SPDX-License-Identifier: Apache-2.0
// Stars of a batch are those of the exact fallback, from every instruction set and with any others in the
// batch. Sampling radii are those of the circumradii. Curves are split where they pass a point again.
#include "engine/boundary/tangential/curves.hpp"
#include "engine/boundary/tangential/stars.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

namespace lacuna::tangential {
namespace {

// ---- Stars

using Link = std::vector<LinkVertex<LocalIndex>>;

// A point among some others.
struct Neighbourhood {
  Site at;
  Eigen::Vector3d normal;
  std::vector<Site> around;
};

Site drawn_seat(Random& random, double x, double y, double z) {
  return {{x, y, z}, {0, 0, random.uniform(-0.05, 0.05)}, random.uniform(0.5, 1), random.uniform(0, 1e-4)};
}

// Noise around a plane, a half plane, a flat lattice with and without weights, and points that project onto
// few places. Also three neighbours or fewer, more than one batch holds, a cluster at the point, and no
// normal.
Neighbourhood drawn_neighbourhood(Random& random) {
  const std::int64_t kind = random.whole(0, 9);
  const auto count = std::size_t(kind == 5 ? random.whole(0, 3) : random.whole(3, kind == 6 ? 90 : 30));
  Neighbourhood drawn{drawn_seat(random, 0, 0, 0), {0, 0, 1}, {}};
  if (kind == 7) drawn.normal = random.direction();
  if (kind == 9) drawn.normal.setConstant(std::nan(""));
  while (drawn.around.size() < count) {
    Eigen::Vector3d q(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3));
    if (kind == 1) q.x() = std::abs(q.x());
    if (kind == 2 || kind == 3) q = {std::round(3 * q.x()), std::round(3 * q.y()), 0};
    if (kind == 4) q = {std::round(q.x()), std::round(q.y()), q.z()};
    if (kind == 8 && random.chance(0.2)) q *= 1e-7;
    if (q.norm() == 0) continue;
    drawn.around.push_back(drawn_seat(random, q.x(), q.y(), q.z()));
    if (kind == 3) drawn.around.back().weight = drawn.at.weight;
    if (kind == 2 || kind == 3) drawn.around.back().shift[2] = drawn.at.shift[2];
  }
  return drawn;
}

std::vector<Neighbourhood> drawn_neighbourhoods(Random& random) {
  std::vector<Neighbourhood> drawn;
  for (std::size_t i = 0; i < kBatchSize; ++i) drawn.push_back(drawn_neighbourhood(random));
  return drawn;
}

// The sites of several neighbourhoods, and what is wanted of them.
struct Queries {
  std::vector<Site> sites;
  std::vector<std::vector<LocalIndex>> neighbours;
  std::vector<StarQuery> all;

  explicit Queries(const std::vector<Neighbourhood>& neighbourhoods) {
    for (const Neighbourhood& n : neighbourhoods) {
      const auto at = static_cast<LocalIndex>(sites.size());
      sites.push_back(n.at);
      std::vector<LocalIndex>& row = neighbours.emplace_back();
      for (const Site& seat : n.around) {
        row.push_back(static_cast<LocalIndex>(sites.size()));
        sites.push_back(seat);
      }
      all.push_back({at, n.normal, {}});
    }
    for (std::size_t i = 0; i < all.size(); ++i) all[i].neighbours = neighbours[i];
  }
};

std::vector<Link> found_side_by_side(const Queries& queries) {
  std::vector<Link> stars(queries.all.size());
  StarFinder(queries.sites)
      .for_each_batch(
          queries.all.size(), [&](std::size_t i) { return queries.all[i]; },
          [&](std::size_t first, std::span<const FoundStar> batch) {
            for (std::size_t i = 0; i < batch.size(); ++i)
              for (std::size_t c = 0; c < batch[i].size(); ++c) stars[first + i].push_back(batch[i][c]);
          });
  return stars;
}

bool same_bits(const Link& a, const Link& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

StarBatch batch_of(const Queries& queries) {
  StarBatch batch{.sites = queries.sites.data()};
  for (std::size_t i = 0; i < kBatchSize; ++i) {
    const StarQuery& query = queries.all[i];
    batch.points[i] = query.point;
    batch.neighbours[i] = query.neighbours.empty() ? &query.point : query.neighbours.data();
    batch.counts[i] = static_cast<std::uint32_t>(std::min(query.neighbours.size(), kMostNeighbours));
    for (int axis = 0; axis < 3; ++axis) batch.normals[axis][i] = query.normal[axis];
  }
  return batch;
}

StarRadii radii_among(const std::vector<float>& radii) {
  std::vector<LinkVertex<LocalIndex>> link;
  for (const float radius : radii) link.push_back({0, radius});
  return smallest_radii(link, {.hole_radius = 0.8});
}

TEST_CASE("stars found side by side are those of the exact fallback, bit for bit") {
  Random random(21);
  std::size_t different = 0, vertices = 0;
  for (int round = 0; round < 3000; ++round) {
    const Queries queries(drawn_neighbourhoods(random));
    const std::vector<Link> found = found_side_by_side(queries);
    for (std::size_t i = 0; i < found.size(); ++i) {
      different += !same_bits(found[i], find_star_exactly(queries.sites, queries.all[i]).link);
      vertices += found[i].size();
    }
  }
  CHECK(different == 0);
  CHECK(vertices > 3000);
}

TEST_CASE("nearly every star is decided side by side, from every instruction set with the same bits") {
  Random random(22);
  std::size_t different = 0, unlike_exact = 0, plain_ones = 0, ambiguous = 0;
  for (int round = 0; round < 3000; ++round) {
    const Queries queries(drawn_neighbourhoods(random));
    const StarBatch batch = batch_of(queries);
    BatchStars expected, found;
    find_batch_stars(batch, expected);
    by_each_instruction_set([&] {
      find_batch_stars(batch, found);
      for (std::size_t i = 0; i < kBatchSize; ++i) {
        different += found.sizes[i] != expected.sizes[i];
        if (found.sizes[i] == BatchStars::kAmbiguous || found.sizes[i] != expected.sizes[i]) continue;
        for (std::uint32_t c = 0; c < found.sizes[i]; ++c)
          different += std::memcmp(&found.links[c][i], &expected.links[c][i], sizeof found.links[0][0]) != 0;
      }
    });
    for (std::size_t i = 0; i < kBatchSize; ++i) {
      if (queries.all[i].neighbours.size() > kMostNeighbours) continue;
      const auto [exact, distance] = find_star_exactly(queries.sites, queries.all[i]);
      if (expected.sizes[i] == BatchStars::kAmbiguous) {
        ++ambiguous;
        continue;
      }
      ++plain_ones;
      Link star;
      for (std::uint32_t c = 0; c < expected.sizes[i]; ++c) star.push_back(expected.links[c][i]);
      unlike_exact += !same_bits(star, exact);
      if (!exact.empty()) unlike_exact += expected.distances[i] != distance;
    }
  }
  CHECK(different == 0);
  CHECK(unlike_exact == 0);
  CHECK(ambiguous > 0);  // lattices without weights
  CHECK(plain_ones > 3 * ambiguous);
}

TEST_CASE("the sampling radius depends on the circumradii alone, not on their order or their stars") {
  Random random(4);
  for (int round = 0; round < 100; ++round) {
    std::vector<float> radii(static_cast<std::size_t>(random.whole(1, 300)));
    for (float& radius : radii) radius = static_cast<float>(random.uniform(0, 0.8));
    const double bound = random.uniform(0.1, 1);
    const auto within = [&](std::size_t of_a_star) {
      std::vector<StarRadii> stars{radii_among({})};  // of the point, then of its neighbours
      std::vector<LocalIndex> neighbours;
      for (std::size_t i = 0; i < radii.size(); i += of_a_star) {
        neighbours.push_back(static_cast<LocalIndex>(stars.size()));
        stars.push_back(radii_among(
            {radii.begin() + long(i), radii.begin() + long(std::min(i + of_a_star, radii.size()))}));
      }
      RadiiAround around;
      around.gather(0, neighbours, [&](LocalIndex q) { return ScaledRadii{stars[q], 1.0}; });
      return around.sampling_radius(bound);
    };
    const double at_once = within(8);
    std::sort(radii.begin(), radii.end());
    CHECK(within(3) == at_once);
    std::erase_if(radii, [&](float radius) { return radius >= bound; });
    if (radii.empty()) continue;
    const double exact = radii[radii.size() * 9 / 10];
    CHECK(at_once > exact);
    CHECK(at_once <= exact + bound / 64 * (1 + 1e-9));
  }
}

// ---- Curves

std::vector<CurveStep> curve_of(const std::vector<std::uint64_t>& ids) {
  std::vector<CurveStep> curve;
  for (std::size_t i = 0; i < ids.size(); ++i) curve.push_back({PointId{ids[i]}, i});
  return curve;
}

// The results in memory, and in mapped arrays of no budget.
std::vector<CurveStep> normalised(const std::vector<CurveStep>& curve) {
  const ScratchFolder folder;
  Scratch scratch(folder.path(), 1 << 20);
  std::vector<CurveStep> turned(curve.size());
  normalise(curve, turned, scratch);
  return turned;
}

std::vector<std::vector<CurveStep>> split(const std::vector<CurveStep>& curve,
                                          std::uint64_t budget = 1 << 20) {
  const ScratchFolder folder;
  Scratch scratch(folder.path(), budget);
  std::vector<std::vector<CurveStep>> curves;
  const auto by_id = [](const CurveStep& step) {
    return std::array{static_cast<double>(value(step.id)), 0., 0.};
  };
  split_at_pinches(curve, by_id, scratch, [&](std::span<const CurveStep> simple) {
    curves.emplace_back(simple.begin(), simple.end());
  });
  return curves;
}

std::vector<std::uint64_t> ids(const std::vector<CurveStep>& curve) {
  std::vector<std::uint64_t> ids;
  for (const CurveStep& p : curve) ids.push_back(value(p.id));
  return ids;
}

TEST_CASE("a curve is split where it passes a point again, into curves that pass each point once") {
  const auto parts = [](const std::vector<std::uint64_t>& curve) {
    std::vector<std::vector<std::uint64_t>> curves;
    for (const auto& simple : split(curve_of(curve))) curves.push_back(ids(simple));
    return curves;
  };
  using Curves = std::vector<std::vector<std::uint64_t>>;
  CHECK(parts({1, 2, 3, 4}) == Curves{{1, 2, 3, 4}});
  CHECK(parts({1, 2, 9, 8, 7, 2, 3}) == Curves{{2, 7, 8, 9}, {1, 2, 3}});
  CHECK(parts({1, 5, 4, 1, 2, 3}) == Curves{{1, 2, 3}, {1, 4, 5}});
  CHECK(parts({1, 6, 7, 8, 7, 6, 3}) == Curves{{7, 8}, {6, 7}, {1, 3, 6}});  // a spike, there and back
  CHECK(parts({1, 5, 2, 1, 5, 3}) == Curves{{1, 2, 5}, {1, 3, 5}});
  const auto both = split(curve_of({1, 2, 3, 2, 4}));
  REQUIRE(both.size() == 2);
  CHECK(both[1][1].wedge == 3);  // of the pass that stays on the curve
}

// Whatever the curve, its parts pass each point once and have all its points, the same in mapped arrays.
void check_random_curves(std::uint64_t seed, int rounds, int longest) {
  Random random(seed);
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::uint64_t> passed(std::size_t(random.whole(3, longest)));
    const auto points = static_cast<std::int64_t>(passed.size()) / random.whole(1, 8) + 3;
    for (auto& p : passed) p = static_cast<std::uint64_t>(random.whole(0, points));
    const std::vector<CurveStep> curve = curve_of(passed);
    const std::vector<std::vector<CurveStep>> parts = split(curve);
    std::vector<std::uint64_t> all;
    std::size_t wrong = 0;
    for (const auto& part : parts) {
      const std::vector<std::uint64_t> of_part = ids(part);
      wrong += std::set(of_part.begin(), of_part.end()).size() != of_part.size();
      wrong += of_part != ids(normalised(part));
      all.insert(all.end(), of_part.begin(), of_part.end());
    }
    std::sort(all.begin(), all.end());
    std::sort(passed.begin(), passed.end());
    CHECK(wrong == 0);
    CHECK(all == passed);
    const std::vector<std::vector<CurveStep>> mapped = split(curve, 1);
    const bool same = std::equal(parts.begin(), parts.end(), mapped.begin(), mapped.end(),
                                 [](const auto& a, const auto& b) { return ids(a) == ids(b); });
    CHECK(same);
  }
}

TEST_CASE("random curves are split into simple ones, in memory and in mapped files") {
  check_random_curves(11, 56, 200);
  check_random_curves(12, 1, 30'000);
}

}  // namespace
}  // namespace lacuna::tangential
