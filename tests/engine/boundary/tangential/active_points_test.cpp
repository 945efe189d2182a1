// Rough points are searched for along refused triangles; what other tiles may add is foreseen.
#include "engine/boundary/tangential/active_points.hpp"

#include "engine/boundary/tangential/radius_bound.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/tile.hpp"

#include <array>
#include <cstring>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

constexpr double kThreshold = 0.5;

using Star = std::vector<LinkVertex<LocalIndex>>;

// A cloud with all that stars are found from.
struct Judged {
  TilePoints points;
  Rows rows;
  std::vector<Evaluation> evaluations;

  explicit Judged(const Cloud& cloud) : points(whole_tile(cloud)), rows(find_neighbourhoods(points, 15, 0)) {
    const Config config;
    evaluations = evaluate(points, rows, {}, config.normals, config.criteria);
  }
};

// The stars of all points, measured if all are found.
std::vector<Star> measured_stars(const Judged& judged, bool measure = true) {
  std::vector<Site> sites;
  for (LocalIndex p = 0; p < judged.points.owned; ++p)
    sites.push_back(site_of(judged.points.positions[p], judged.points.ids[p], judged.evaluations[p]));
  std::vector<Star> stars(judged.points.owned);
  std::vector<Sampling> samplings(judged.points.owned);
  for (LocalIndex p = 0; p < judged.points.owned; ++p) {
    const ExactStar found = find_star_exactly(sites, {p, judged.evaluations[p].normal, judged.rows[p]});
    stars[p] = found.corners;
    const FoundStar star(found.corners.data(), 1, found.corners.size(), found.distance);
    samplings[p] = samplings_of(std::span(&star, 1), {})[0];
    for (auto& corner : stars[p]) corner.point = judged.rows[p][corner.point];
  }
  if (!measure) return stars;
  RadiusBounder(samplings, {})
      .for_each(
          stars.size(),
          [&](std::size_t p) {
            return Surroundings{static_cast<LocalIndex>(p), judged.rows[p]};
          },
          [&](std::size_t p, const RadiusBound& size) {
            for (auto& corner : stars[p]) corner.room = room_beyond(size, samplings[p], corner.room);
          });
  return stars;
}

bool has(const Star& star, LocalIndex a, LocalIndex b) {
  return has_triangle(std::span<const LinkVertex<LocalIndex>>(star), a, b);
}

bool is_agreed(const std::vector<Star>& stars, const std::vector<bool>& active, LocalIndex p, std::size_t i) {
  const LocalIndex a = stars[p][i].point, b = stars[p][(i + 1) % stars[p].size()].point;
  return stars[p][i].room <= 0 && (!active[a] || has(stars[a], p, b)) && (!active[b] || has(stars[b], p, a));
}

// Seeds, these `others`, and corners of triangles that are not agreed, until there are no more.
std::vector<bool> rough_points(const Judged& judged, const std::vector<Star>& stars,
                               const std::vector<LocalIndex>& others) {
  std::vector<bool> active(stars.size());
  for (LocalIndex p = 0; p < stars.size(); ++p) active[p] = is_seed(judged.evaluations[p], kThreshold);
  for (const LocalIndex p : others) active[p] = true;
  for (bool go_on = true; go_on;) {
    std::vector<bool> more = active;
    for (LocalIndex p = 0; p < stars.size(); ++p) {
      for (std::size_t i = 0; active[p] && i < stars[p].size(); ++i) {
        if (!is_agreed(stars, active, p, i))
          more[stars[p][i].point] = more[stars[p][(i + 1) % stars[p].size()].point] = true;
      }
    }
    go_on = more != active;
    active = more;
  }
  return active;
}

bool same_bits(std::span<const LinkVertex<LocalIndex>> a, const Star& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

Cloud drawn_cloud(std::uint64_t seed) {
  return seed == 1 ? plane(40) : seed == 2 ? hard_cloud(5) : random_cloud(3000 + seed);
}

}  // namespace

TEST_CASE("in one tile the active points are those found by definition, and so are their consistencies") {
  std::array<std::size_t, 3> consistencies{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Judged judged(drawn_cloud(seed));
    const std::vector<Star> stars = measured_stars(judged);
    const std::vector<bool> active = rough_points(judged, stars, {});
    const std::vector<std::uint8_t> is_border(judged.points.owned);
    const TileStars found =
        find_stars(judged.points, judged.rows, judged.evaluations, is_border, kThreshold, {});
    std::size_t wrong_standings = 0, wrong_stars = 0, wrong_agreements = 0;
    for (LocalIndex p = 0; p < judged.points.owned; ++p) {
      wrong_standings += found.states[p] != (active[p] ? PointState::kActive : PointState::kInactive);
      wrong_standings += (found.is_active[p] != 0) != active[p];
      if (!active[p]) continue;
      wrong_stars += !same_bits(found.stars[p], stars[p]);
      for (std::size_t i = 0; i < stars[p].size(); ++i) {
        const Consistency expected =
            is_agreed(stars, active, p, i) ? Consistency::kConsistent : Consistency::kInconsistent;
        wrong_agreements += found.stars.consistencies_of(p)[i] != expected;
        ++consistencies[static_cast<std::size_t>(expected)];
      }
    }
    INFO("seed " << seed);
    CHECK(wrong_standings == 0);
    CHECK(wrong_stars == 0);
    CHECK(wrong_agreements == 0);
  }
  CHECK(consistencies[static_cast<std::size_t>(Consistency::kConsistent)] > 1000);
  CHECK(consistencies[static_cast<std::size_t>(Consistency::kInconsistent)] > 1000);
}

TEST_CASE("whatever is found at the border, what a tile calls active, inner or settled stays so") {
  std::array<std::size_t, 5> counts{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Judged judged(drawn_cloud(seed));
    const std::vector<Star> stars = measured_stars(judged), found_stars = measured_stars(judged, false);
    Random random(seed);
    std::vector<std::uint8_t> is_border(judged.points.owned);
    for (auto& border : is_border) border = random.chance(0.01);
    const TileStars found =
        find_stars(judged.points, judged.rows, judged.evaluations, is_border, kThreshold, {});
    for (int round = 0; round < 5; ++round) {
      // The stars of points that wait turn out as they like, and some of the border are active.
      std::vector<Star> turned_out = stars;
      std::vector<LocalIndex> others;
      for (LocalIndex p = 0; p < judged.points.owned; ++p) {
        if (is_border[p] && random.chance(0.3)) others.push_back(p);
        if (!waits(found.states[p]) || round == 0) continue;
        if (is_border[p] && random.chance(0.3)) turned_out[p].clear();
        for (auto& corner : turned_out[p]) {
          if (random.chance(0.2)) corner.room = static_cast<float>(random.uniform(-1, 1));
        }
      }
      const std::vector<bool> active = rough_points(judged, turned_out, others);
      std::size_t wrong = 0;
      for (LocalIndex p = 0; p < judged.points.owned; ++p) {
        const PointState state = found.states[p];
        bool sees_border = false;
        for (const LocalIndex q : judged.rows[p]) sees_border |= is_border[q] != 0;
        wrong += waits(state) != (is_border[p] || sees_border);
        wrong += (state == PointState::kBorder) != (is_border[p] != 0);
        wrong += (state == PointState::kInactive && active[p]) || (found.is_active[p] && !active[p]);
        wrong += !waits(state) && (found.is_active[p] != 0) != (state == PointState::kActive);
        if (is_measured(state)) wrong += !same_bits(found.stars[p], stars[p]);
        if (state == PointState::kBeside) wrong += !same_bits(found.stars[p], found_stars[p]);
        for (std::size_t i = 0; state == PointState::kActive && i < stars[p].size(); ++i) {
          const Consistency consistency = found.stars.consistencies_of(p)[i];
          if (consistency == Consistency::kUndecided) continue;
          wrong += (consistency == Consistency::kConsistent) != is_agreed(turned_out, active, p, i);
        }
        ++counts[static_cast<std::size_t>(state)];
      }
      INFO("seed " << seed << ", round " << round);
      CHECK(wrong == 0);
    }
  }
  for (const std::size_t count : counts) CHECK(count > 100);
}

}  // namespace lacuna
