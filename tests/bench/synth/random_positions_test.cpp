// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/synth/made.hpp"

using namespace lacuna;
using namespace lacuna::synth;

namespace {

SurfaceOptions random_surface(const ScratchFolder& folder, SurfaceKind kind = SurfaceKind::kPlane) {
  SurfaceOptions options = small_surface(folder, kind);
  options.positions = PositionKind::kRandom;
  options.spacing = 1;
  return options;
}

std::vector<Position> on_loop(const std::vector<std::uint64_t>& loop, const std::vector<Position>& points) {
  std::vector<Position> corners;
  for (const std::uint64_t id : loop) corners.push_back(points.at(id));
  return corners;
}

// Twice the signed area of a triangle in x and y.
double turn(const Position& a, const Position& b, const Position& c) {
  return (double(b[0]) - a[0]) * (double(c[1]) - a[1]) - (double(b[1]) - a[1]) * (double(c[0]) - a[0]);
}

double area(const std::vector<Position>& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    twice += turn({0, 0, 0}, corners[i], corners[(i + 1) % corners.size()]);
  return std::fabs(twice) / 2;
}

bool encloses(const std::vector<Position>& corners, const Position& p) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Position& a = corners[i];
    const Position& b = corners[(i + 1) % corners.size()];
    if ((a[1] > p[1]) != (b[1] > p[1]) && (turn(a, b, p) > 0) == (b[1] > a[1])) inside = !inside;
  }
  return inside;
}

bool cross(const Position& a, const Position& b, const Position& c, const Position& d) {
  return (turn(a, b, c) > 0) != (turn(a, b, d) > 0) && (turn(c, d, a) > 0) != (turn(c, d, b) > 0);
}

}  // namespace

TEST_CASE("random positions are uniform and independent, those near a grid are not") {
  // Bins that do not follow the squares of the grid. The numbers of points in them are Poisson numbers if
  // positions are independent: then the sum of squared deviations has the chi-square distribution.
  constexpr int kBins = 60;
  const auto chi_square = [](PositionKind positions, double bin) {
    const ScratchFolder folder;
    SurfaceOptions options = random_surface(folder);
    options.positions = positions;
    options.points = 40'000;
    options.holes = 0;
    write_surface(options);
    std::map<std::array<int, 2>, double> counts;
    for (const Position& p : positions_of(options.out))
      ++counts[{int(std::floor(p[0] / bin)), int(std::floor(p[1] / bin))}];
    double sum = 0;
    for (int x = 0; x < kBins; ++x)
      for (int y = 0; y < kBins; ++y) sum += std::pow(counts[{x, y}] - bin * bin, 2) / (bin * bin);
    return sum;
  };
  constexpr double kDegrees = kBins * kBins;
  const double deviation = std::sqrt(2 * kDegrees);
  for (const double bin : {0.7, 1.3, 3.3}) {
    CHECK(std::fabs(chi_square(PositionKind::kRandom, bin) - kDegrees) < 4 * deviation);
    CHECK(chi_square(PositionKind::kJittered, bin) < kDegrees - 10 * deviation);
  }
}

TEST_CASE(
    "the true loops of random positions enclose their holes and no point, and do not cross themselves") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const ScratchFolder folder;
    SurfaceOptions options = random_surface(folder);
    options.points = 60'000;
    options.holes = 60;
    options.hole_radius = {1.5, 4};
    options.seed = seed;
    write_surface(options);
    const auto points = positions_of(options.out);
    auto loops = loops_of(options.truth);
    REQUIRE(loops.size() == 61);
    std::sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
    loops.pop_back();  // the outer edge
    for (const auto& loop : loops) {
      const std::vector<Position> corners = on_loop(loop, points);
      const double extent = area(corners);
      CHECK(extent > 0.9 * std::numbers::pi * 1.5 * 1.5);
      CHECK(extent < std::numbers::pi * 6 * 6);
      const std::set<std::uint64_t> of_loop(loop.begin(), loop.end());
      for (std::uint64_t id = 0; id < points.size(); ++id)
        if (!of_loop.contains(id) && distance(points[id], corners[0]) < 20)
          CHECK(!encloses(corners, points[id]));
      for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = i + 2; j < corners.size() - (i == 0); ++j)
          CHECK(!cross(corners[i], corners[i + 1], corners[j], corners[(j + 1) % corners.size()]));
    }
  }
}
