// Rough points are searched for along refused triangles; what other tiles may add is foreseen.
#include "engine/stages/tile_stars.hpp"

#include "engine/stages/ball_sizes.hpp"
#include "engine/stages/evaluate.hpp"
#include "engine/stages/neighbourhoods.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/tile.hpp"

#include <array>
#include <cstring>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

constexpr double kThreshold = 0.5;

using Star = std::vector<StarCorner<LocalIndex>>;

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
  std::vector<Seat> seats;
  for (LocalIndex p = 0; p < judged.points.owned; ++p)
    seats.push_back(seat_of(judged.points.positions[p], judged.points.ids[p], judged.evaluations[p]));
  std::vector<Star> stars(judged.points.owned);
  std::vector<Sampling> samplings(judged.points.owned);
  for (LocalIndex p = 0; p < judged.points.owned; ++p) {
    const ExactStar found = find_star_exactly(seats, {p, judged.evaluations[p].normal, judged.rows[p]});
    stars[p] = found.corners;
    const FoundStar star(found.corners.data(), 1, found.corners.size(), found.distance);
    samplings[p] = samplings_of(std::span(&star, 1), {})[0];
    for (auto& corner : stars[p]) corner.point = judged.rows[p][corner.point];
  }
  if (!measure) return stars;
  BallSizer(samplings, {})
      .for_each(
          stars.size(),
          [&](std::size_t p) {
            return Surroundings{static_cast<LocalIndex>(p), judged.rows[p]};
          },
          [&](std::size_t p, const BallSize& size) {
            for (auto& corner : stars[p]) corner.room = room_beyond(size, samplings[p], corner.room);
          });
  return stars;
}

bool has(const Star& star, LocalIndex a, LocalIndex b) {
  return has_triangle(std::span<const StarCorner<LocalIndex>>(star), a, b);
}

bool is_agreed(const std::vector<Star>& stars, const std::vector<bool>& rough, LocalIndex p, std::size_t i) {
  const LocalIndex a = stars[p][i].point, b = stars[p][(i + 1) % stars[p].size()].point;
  return stars[p][i].room <= 0 && (!rough[a] || has(stars[a], p, b)) && (!rough[b] || has(stars[b], p, a));
}

// Seeds, these `others`, and corners of triangles that are not agreed, until there are no more.
std::vector<bool> rough_points(const Judged& judged, const std::vector<Star>& stars,
                               const std::vector<LocalIndex>& others) {
  std::vector<bool> rough(stars.size());
  for (LocalIndex p = 0; p < stars.size(); ++p) rough[p] = is_seed(judged.evaluations[p], kThreshold);
  for (const LocalIndex p : others) rough[p] = true;
  for (bool go_on = true; go_on;) {
    std::vector<bool> more = rough;
    for (LocalIndex p = 0; p < stars.size(); ++p) {
      for (std::size_t i = 0; rough[p] && i < stars[p].size(); ++i) {
        if (!is_agreed(stars, rough, p, i))
          more[stars[p][i].point] = more[stars[p][(i + 1) % stars[p].size()].point] = true;
      }
    }
    go_on = more != rough;
    rough = more;
  }
  return rough;
}

bool same_bits(std::span<const StarCorner<LocalIndex>> a, const Star& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

Cloud drawn_cloud(std::uint64_t seed) {
  return seed == 1 ? plane(40) : seed == 2 ? hard_cloud(5) : random_cloud(3000 + seed);
}

}  // namespace

TEST_CASE("in one tile the rough points are those found by definition, and so are their agreements") {
  std::array<std::size_t, 3> agreements{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Judged judged(drawn_cloud(seed));
    const std::vector<Star> stars = measured_stars(judged);
    const std::vector<bool> rough = rough_points(judged, stars, {});
    const std::vector<std::uint8_t> is_border(judged.points.owned);
    const TileStars found =
        find_stars(judged.points, judged.rows, judged.evaluations, is_border, kThreshold, {});
    std::size_t wrong_standings = 0, wrong_stars = 0, wrong_agreements = 0;
    for (LocalIndex p = 0; p < judged.points.owned; ++p) {
      wrong_standings += found.standings[p] != (rough[p] ? Standing::kRough : Standing::kInner);
      wrong_standings += (found.is_rough[p] != 0) != rough[p];
      if (!rough[p]) continue;
      wrong_stars += !same_bits(found.stars[p], stars[p]);
      for (std::size_t i = 0; i < stars[p].size(); ++i) {
        const Agreement expected = is_agreed(stars, rough, p, i) ? Agreement::kAgreed : Agreement::kRefused;
        wrong_agreements += found.stars.agreements_of(p)[i] != expected;
        ++agreements[static_cast<std::size_t>(expected)];
      }
    }
    INFO("seed " << seed);
    CHECK(wrong_standings == 0);
    CHECK(wrong_stars == 0);
    CHECK(wrong_agreements == 0);
  }
  CHECK(agreements[static_cast<std::size_t>(Agreement::kAgreed)] > 1000);
  CHECK(agreements[static_cast<std::size_t>(Agreement::kRefused)] > 1000);
}

TEST_CASE("whatever is found at the border, what a tile calls rough, inner or settled stays so") {
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
      // The stars of points that wait turn out as they like, and some of the border are rough.
      std::vector<Star> turned_out = stars;
      std::vector<LocalIndex> others;
      for (LocalIndex p = 0; p < judged.points.owned; ++p) {
        if (is_border[p] && random.chance(0.3)) others.push_back(p);
        if (!waits(found.standings[p]) || round == 0) continue;
        if (is_border[p] && random.chance(0.3)) turned_out[p].clear();
        for (auto& corner : turned_out[p]) {
          if (random.chance(0.2)) corner.room = static_cast<float>(random.uniform(-1, 1));
        }
      }
      const std::vector<bool> rough = rough_points(judged, turned_out, others);
      std::size_t wrong = 0;
      for (LocalIndex p = 0; p < judged.points.owned; ++p) {
        const Standing standing = found.standings[p];
        bool sees_border = false;
        for (const LocalIndex q : judged.rows[p]) sees_border |= is_border[q] != 0;
        wrong += waits(standing) != (is_border[p] || sees_border);
        wrong += (standing == Standing::kBorder) != (is_border[p] != 0);
        wrong += (standing == Standing::kInner && rough[p]) || (found.is_rough[p] && !rough[p]);
        wrong += !waits(standing) && (found.is_rough[p] != 0) != (standing == Standing::kRough);
        if (is_measured(standing)) wrong += !same_bits(found.stars[p], stars[p]);
        if (standing == Standing::kBeside) wrong += !same_bits(found.stars[p], found_stars[p]);
        for (std::size_t i = 0; standing == Standing::kRough && i < stars[p].size(); ++i) {
          const Agreement agreement = found.stars.agreements_of(p)[i];
          if (agreement == Agreement::kOpen) continue;
          wrong += (agreement == Agreement::kAgreed) != is_agreed(turned_out, rough, p, i);
        }
        ++counts[static_cast<std::size_t>(standing)];
      }
      INFO("seed " << seed << ", round " << round);
      CHECK(wrong == 0);
    }
  }
  for (const std::size_t count : counts) CHECK(count > 100);
}

}  // namespace lacuna
