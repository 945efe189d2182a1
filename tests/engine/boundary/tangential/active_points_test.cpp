// SPDX-License-Identifier: Apache-2.0
// Active points are found along inconsistent triangles, and so are those that other tiles may add.
#include "engine/boundary/tangential/active_points.hpp"

#include "engine/boundary/tangential/stars.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/tile.hpp"

namespace lacuna::tangential {
namespace {

constexpr double kThreshold = 0.5;

// A star by definition, found or measured.
struct PlainStar {
  std::vector<LinkVertex<LocalIndex>> link;
  RadiusBound bound;

  operator Star<LocalIndex>() const { return {link, bound}; }
  std::size_t size() const { return link.size(); }
};

// A cloud with all that its stars need.
struct EvaluatedCloud {
  TilePoints points;
  Neighbourhoods rows;
  std::vector<Evaluation> evaluations;

  explicit EvaluatedCloud(const Cloud& cloud)
      : points(whole_tile(cloud)), rows(find_neighbourhoods(points, 15, 0)) {
    const Config config;
    evaluations = evaluate(points, rows, {}, config.normals, config.criteria);
  }
};

// The stars of all points, measured.
std::vector<PlainStar> measured_stars(const EvaluatedCloud& evaluated) {
  std::vector<Site> sites;
  for (LocalIndex p = 0; p < evaluated.points.owned; ++p)
    sites.push_back(site_of(evaluated.points.positions[p], evaluated.evaluations[p]));
  std::vector<PlainStar> stars(evaluated.points.owned);
  std::vector<Sampling> samplings(evaluated.points.owned);
  for (LocalIndex p = 0; p < evaluated.points.owned; ++p) {
    const ExactStar found = find_star_exactly(sites, {p, evaluated.evaluations[p].normal, evaluated.rows[p]});
    stars[p].link = found.link;
    const FoundStar star(found.link.data(), 1, found.link.size(), found.distance);
    samplings[p] = samplings_of(std::span(&star, 1), {})[0];
    for (auto& vertex : stars[p].link) vertex.point = evaluated.rows[p][vertex.point];
  }
  RadiusBounder(samplings, {})
      .for_each(
          stars.size(),
          [&](std::size_t p) {
            return PointAndNeighbours{static_cast<LocalIndex>(p), evaluated.rows[p]};
          },
          [&](std::size_t p, const RadiusBound& bound) { stars[p].bound = bound; });
  return stars;
}

// The coarsest scale at which the stars of the active vertices have the triangle.
Scale scale_of(const std::vector<PlainStar>& stars, const std::vector<bool>& active, LocalIndex p,
               std::size_t i) {
  const Star<LocalIndex> star = stars[p];
  const auto scale = [&](LocalIndex vertex, LocalIndex a, LocalIndex b) {
    return active[vertex] ? Star<LocalIndex>(stars[vertex]).scale_of(a, b) : Scale::kFine;
  };
  const LocalIndex a = star.link[i].point, b = star.link[star.next(i)].point;
  return std::max({star.scale_of(i), scale(a, p, b), scale(b, p, a)});
}

// Seeds, these `others`, and vertices of inconsistent triangles, until there are no more.
std::vector<bool> active_points(const EvaluatedCloud& evaluated, const std::vector<PlainStar>& stars,
                                const std::vector<LocalIndex>& others) {
  std::vector<bool> active(stars.size());
  for (LocalIndex p = 0; p < stars.size(); ++p) active[p] = evaluated.evaluations[p].probability > kThreshold;
  for (const LocalIndex p : others) active[p] = true;
  for (bool go_on = true; go_on;) {
    std::vector<bool> more = active;
    for (LocalIndex p = 0; p < stars.size(); ++p) {
      for (std::size_t i = 0; active[p] && i < stars[p].size(); ++i) {
        if (scale_of(stars, active, p, i) != Scale::kFine)
          more[stars[p].link[i].point] = more[stars[p].link[(i + 1) % stars[p].size()].point] = true;
      }
    }
    go_on = more != active;
    active = more;
  }
  return active;
}

bool same_link(const Star<LocalIndex>& a, const PlainStar& b) {
  return a.size() == b.size() &&
         (a.size() == 0 || std::memcmp(a.link.data(), b.link.data(), a.link.size_bytes()) == 0);
}

bool same_star(const Star<LocalIndex>& a, const PlainStar& b) {
  return same_link(a, b) && a.bound.fine == b.bound.fine && a.bound.coarse == b.bound.coarse;
}

TileStars stars_in(const EvaluatedCloud& evaluated, std::span<const std::uint8_t> is_border) {
  std::vector<LocalIndex> seeds;
  for (LocalIndex p = 0; p < evaluated.points.owned; ++p)
    if (evaluated.evaluations[p].probability > kThreshold) seeds.push_back(p);
  return find_stars(evaluated.points, evaluated.rows, evaluated.evaluations, seeds, is_border, {});
}

Cloud drawn_cloud(std::uint64_t seed) {
  return seed == 1 ? plane(40) : seed == 2 ? hard_cloud(5) : random_cloud(3000 + seed);
}

}  // namespace

TEST_CASE("in one tile the active points are those found by definition, and so are their consistencies") {
  std::array<std::size_t, 3> scales{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const EvaluatedCloud evaluated(drawn_cloud(seed));
    const std::vector<PlainStar> stars = measured_stars(evaluated);
    const std::vector<bool> active = active_points(evaluated, stars, {});
    const std::vector<std::uint8_t> is_border(evaluated.points.owned);
    const TileStars found = stars_in(evaluated, is_border);
    std::size_t wrong_states = 0, wrong_stars = 0, wrong_consistencies = 0;
    for (LocalIndex p = 0; p < evaluated.points.owned; ++p) {
      wrong_states += found.states[p] != (active[p] ? PointState::kActive : PointState::kInactive);
      wrong_states += (found.is_active[p] != 0) != active[p];
      if (!active[p]) continue;
      wrong_stars += !same_star(found.stars[p], stars[p]);
      for (std::size_t i = 0; i < stars[p].size(); ++i) {
        const Scale expected = scale_of(stars, active, p, i);
        const Consistency consistency = found.stars.consistencies_of(p)[i];
        wrong_consistencies += consistency.scale != expected || consistency.is_undecided;
        ++scales[static_cast<std::size_t>(expected)];
      }
    }
    INFO("seed " << seed);
    CHECK(wrong_states == 0);
    CHECK(wrong_stars == 0);
    CHECK(wrong_consistencies == 0);
  }
  for (const std::size_t count : scales) CHECK(count > 1000);
}

TEST_CASE("whatever is found at the border, points and triangles that a tile decided stay as they are") {
  std::array<std::size_t, 5> counts{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const EvaluatedCloud evaluated(drawn_cloud(seed));
    const std::vector<PlainStar> stars = measured_stars(evaluated);
    Random random(seed);
    std::vector<std::uint8_t> is_border(evaluated.points.owned);
    for (auto& border : is_border) border = random.chance(0.01);
    const TileStars found = stars_in(evaluated, is_border);
    for (int round = 0; round < 5; ++round) {
      // The stars of the belt turn out as they like, and some of the border are active.
      std::vector<PlainStar> turned_out = stars;
      std::vector<LocalIndex> others;
      for (LocalIndex p = 0; p < evaluated.points.owned; ++p) {
        if (is_border[p] && random.chance(0.3)) others.push_back(p);
        if (!is_in_belt(found.states[p]) || round == 0) continue;
        if (is_border[p] && random.chance(0.3)) turned_out[p].link.clear();
        for (auto& vertex : turned_out[p].link) {
          if (random.chance(0.2))
            vertex.radius = turned_out[p].bound.fine * static_cast<float>(random.uniform(0, 4));
        }
      }
      const std::vector<bool> active = active_points(evaluated, turned_out, others);
      std::size_t wrong = 0;
      for (LocalIndex p = 0; p < evaluated.points.owned; ++p) {
        const PointState state = found.states[p];
        bool borders = false;
        for (const LocalIndex q : evaluated.rows[p]) borders |= is_border[q] != 0;
        wrong += is_in_belt(state) != (is_border[p] || borders);
        wrong += (state == PointState::kBorder) != (is_border[p] != 0);
        wrong += (state == PointState::kInactive && active[p]) || (found.is_active[p] && !active[p]);
        wrong += !is_in_belt(state) && (found.is_active[p] != 0) != (state == PointState::kActive);
        if (is_measured(state)) wrong += !same_star(found.stars[p], stars[p]);
        if (state == PointState::kInner) wrong += !same_link(found.stars[p], stars[p]);
        for (std::size_t i = 0; state == PointState::kActive && i < stars[p].size(); ++i) {
          const Consistency consistency = found.stars.consistencies_of(p)[i];
          const Scale expected = scale_of(turned_out, active, p, i);
          wrong += consistency.is_undecided ? consistency.scale > expected : consistency.scale != expected;
        }
        ++counts[static_cast<std::size_t>(state)];
      }
      INFO("seed " << seed << ", round " << round);
      CHECK(wrong == 0);
    }
  }
  for (const std::size_t count : counts) CHECK(count > 100);
}

}  // namespace lacuna::tangential
