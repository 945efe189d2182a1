// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/surface.hpp"

#include "bench/synth/arithmetic.hpp"
#include "tests/bench/made.hpp"

using namespace lacuna;
using namespace lacuna::synth;

namespace {

// Kilobytes of a field of /proc/self/status.
long status_kilobytes(const std::string& field) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(field)) return std::stol(line.substr(field.size()));
  return 0;
}

}  // namespace

TEST_CASE("a surface has the bytes that it had on the machine where this test was written") {
  const ScratchFolder folder;
  const auto hash = [&](SurfaceKind kind, Order order, PositionKind positions = PositionKind::kJittered) {
    SurfaceOptions options = small_surface(folder, kind);
    options.positions = positions;
    options.order = order;
    options.noise = 0.2;
    options.density_factor = 3;
    write_surface(options);
    return fnv1a(read_file(options.out) + read_file(options.truth));
  };
  CHECK(hash(SurfaceKind::kPlane, Order::kScanline) == 0xac2da5faec8d43cau);
  CHECK(hash(SurfaceKind::kWaves, Order::kRandom) == 0x782479e8d7de5885u);
  CHECK(hash(SurfaceKind::kCylinder, Order::kRandom) == 0x8d12dafd8d2990bbu);
  CHECK(hash(SurfaceKind::kTorus, Order::kScanline) == 0x4eb8bc5c40ddf948u);
  CHECK(hash(SurfaceKind::kSphereCap, Order::kScanline) == 0x1d95991d98822254u);
  CHECK(hash(SurfaceKind::kSphere, Order::kRandom) == 0xcce83d1495af3490u);
  CHECK(hash(SurfaceKind::kCube, Order::kScanline) == 0x8421a8ffd21eef1bu);
  CHECK(hash(SurfaceKind::kWaves, Order::kScanline, PositionKind::kRandom) == 0x642598f2a3d9b66bu);
  CHECK(hash(SurfaceKind::kTorus, Order::kRandom, PositionKind::kRandom) == 0x17efbccfbbe1503fu);
  CHECK(hash(SurfaceKind::kSphere, Order::kScanline, PositionKind::kRandom) == 0x00f567d330850a44u);
}

TEST_CASE("past the density step there is the promised part of the points, and the holes are before it") {
  for (const PositionKind positions : kAllPositions)
    for (const std::uint32_t step : {4u, 9u}) {
      const ScratchFolder folder;
      SurfaceOptions options = small_surface(folder);
      options.positions = positions;
      options.density_step = step;
      options.points = 40'000;
      options.holes = 3;
      write_surface(options);
      const auto points = positions_of(options.out);
      float width = 0;
      for (const Position& p : points) width = std::max(width, p[0]);
      const auto between = [&](double low, double high) {
        return double(std::count_if(points.begin(), points.end(), [&](const Position& p) {
          return p[0] > low * width && p[0] < high * width;
        }));
      };
      CHECK(between(0.05, 0.45) / between(0.55, 0.95) == Approx(step).epsilon(0.05));
      const auto loops = read_loops(options.truth);
      CHECK(loops.size() == 4);
      std::size_t past = 0;
      for (const auto& loop : loops)
        past += std::any_of(loop.begin(), loop.end(),
                            [&](std::uint64_t id) { return points[id][0] > 0.5 * width; });
      CHECK(past == 1);  // the outer edge
    }
}

TEST_CASE("noise is along the normal and has the wanted deviation") {
  const ScratchFolder folder;
  SurfaceOptions options = small_surface(folder);
  options.noise = 0.5;
  options.translate = {0, 0, 2};
  write_surface(options);
  double sum = 0, squares = 0;
  const auto points = positions_of(options.out);
  for (const Position& p : points) {
    sum += p[2] - 2;
    squares += (p[2] - 2) * (p[2] - 2);
  }
  CHECK(std::fabs(sum / points.size()) < 1e-4);
  CHECK(std::sqrt(squares / points.size()) == Approx(0.5 * options.spacing).epsilon(0.02));
}

TEST_CASE("two million points take less than 32 MB of memory") {
  const ScratchFolder folder;
  SurfaceOptions options = small_surface(folder, SurfaceKind::kTorus);
  options.points = 2'000'000;
  options.holes = 100;
  options.order = Order::kRandom;
  std::ofstream("/proc/self/clear_refs") << 5;  // resets the peak
  const long before = status_kilobytes("VmRSS:");
  write_surface(options);
  CHECK(status_kilobytes("VmHWM:") - before < 32 * 1024);
}

TEST_CASE("surfaces that cannot be made are refused in one line and leave no file") {
  const ScratchFolder folder;
  const auto refused = [&](auto change) {
    check_refused(folder, small_surface(folder), write_surface, change);
  };
  refused([](SurfaceOptions& o) { o.points = 10; });
  refused([](SurfaceOptions& o) { o.holes = 1000; });
  refused([](SurfaceOptions& o) { o.holes = 0 - std::uint64_t{1}; });
  refused([](SurfaceOptions& o) { o.hole_radius = {5, 4}; });
  refused([](SurfaceOptions& o) { o.hole_radius = {1, 4}; });
  refused([](SurfaceOptions& o) { o.jitter = 0.6; });
  refused([](SurfaceOptions& o) { o.noise = -1; });
  refused([](SurfaceOptions& o) { o.spacing = std::nan(""); });
  refused([](SurfaceOptions& o) { o.density_step = 5; });
  refused([](SurfaceOptions& o) { o.density_factor = 0.5; });
  for (const SurfaceKind kind : {SurfaceKind::kSphere, SurfaceKind::kCube}) {
    refused([kind](SurfaceOptions& o) {
      o.kind = kind;
      o.density_step = 4;
    });
  }
  refused([](SurfaceOptions& o) { o.translate = {1e6, 0, 0}; });  // in floats
  refused([](SurfaceOptions& o) { o.truth = o.out; });
  refused([](SurfaceOptions& o) { o.out = o.out / "no-such-folder" / "made.ply"; });
}

TEST_CASE("a surface replaces an earlier one, and no file of another kind") {
  const ScratchFolder folder;
  SurfaceOptions options = small_surface(folder);
  write_surface(options);
  for (const auto& file : {options.out, options.truth}) {
    write_surface(options);
    const std::string mine = "ply\nformat binary_little_endian 1.0\ncomment lacuna detect\n";
    folder.write(file.filename(), mine);
    CHECK_THROWS_WITH(write_surface(options),
                      Contains(file.string() + ": exists, and this command did not write it"));
    CHECK(read_file(file) == mine);
    options.overwrite = io::Overwrite::kAny;
    write_surface(options);
    CHECK(read_file(file) != mine);
    options.overwrite = io::Overwrite::kOwn;
  }
  CHECK(folder.names().size() == 2);
}

// ---- The true loops

TEST_CASE("every planted hole and every outer edge is one closed true loop in canonical form") {
  const auto check = [](SurfaceKind kind, Order order, PositionKind positions) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder, kind);
    options.order = order;
    options.positions = positions;
    const Made made = write_surface(options);
    const auto points = positions_of(options.out);
    const auto loops = read_loops(options.truth);
    CHECK(points.size() == made.points);
    CHECK(std::fabs(double(made.points) - 20'000) < 500);
    REQUIRE(loops.size() == 5 + rims_of(kind));
    CHECK(std::is_sorted(loops.begin(), loops.end()));
    std::set<std::uint64_t> seen;
    double widest = 0;
    for (const auto& loop : loops) {
      REQUIRE(loop.size() >= 8);
      CHECK(*std::min_element(loop.begin(), loop.end()) == loop.front());
      CHECK(loop[1] < loop.back());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        REQUIRE(loop[i] < points.size());
        CHECK(seen.insert(loop[i]).second);
        widest = std::max(widest, distance(points[loop[i]], points[loop[(i + 1) % loop.size()]]));
      }
    }
    CHECK(widest < (positions == PositionKind::kRandom ? 6 : 3) * options.spacing);
  };
  for (const SurfaceKind kind : kAllKinds)
    for (const Order order : {Order::kScanline, Order::kRandom})
      for (const PositionKind positions : kAllPositions) check(kind, order, positions);
}

TEST_CASE("the true loops are the edges with exactly one whole quad, all of them") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder);
    options.points = 60'000;
    options.holes = 60;
    options.hole_radius = {1.5, 4};
    options.jitter = 0;
    options.seed = seed;
    options.order = Order::kRandom;
    write_surface(options);
    using Node = std::array<int, 2>;
    using Edge = std::set<Node>;
    std::vector<Node> nodes;
    for (const Position& p : positions_of(options.out))
      nodes.push_back({int(std::lround(p[0] / options.spacing)), int(std::lround(p[1] / options.spacing))});
    const std::set<Node> there(nodes.begin(), nodes.end());
    std::map<Edge, int> quads_at;
    for (const auto& [x, y] : there) {
      if (!there.contains({x + 1, y}) || !there.contains({x, y + 1}) || !there.contains({x + 1, y + 1}))
        continue;
      ++quads_at[{{x, y}, {x + 1, y}}];
      ++quads_at[{{x, y + 1}, {x + 1, y + 1}}];
      ++quads_at[{{x, y}, {x, y + 1}}];
      ++quads_at[{{x + 1, y}, {x + 1, y + 1}}];
    }
    std::set<Edge> expected, found;
    for (const auto& [edge, quads] : quads_at)
      if (quads == 1) expected.insert(edge);
    for (const auto& loop : read_loops(options.truth))
      for (std::size_t i = 0; i < loop.size(); ++i)
        CHECK(found.insert({nodes.at(loop[i]), nodes.at(loop[(i + 1) % loop.size()])}).second);
    CHECK(found == expected);
  }
}

TEST_CASE("random order has the points and the true loops of scanline order, in another order") {
  for (const PositionKind positions : kAllPositions) {
    const ScratchFolder folder;
    SurfaceOptions options = small_surface(folder, SurfaceKind::kWaves);
    options.positions = positions;
    write_surface(options);
    auto in_scanlines = positions_of(options.out);
    const auto loops_in_scanlines = places_of(read_loops(options.truth), in_scanlines);
    options.order = Order::kRandom;
    write_surface(options);
    auto at_random = positions_of(options.out);
    CHECK(in_scanlines != at_random);
    CHECK(loops_in_scanlines == places_of(read_loops(options.truth), at_random));
    std::sort(in_scanlines.begin(), in_scanlines.end());
    std::sort(at_random.begin(), at_random.end());
    CHECK(in_scanlines == at_random);
  }
}

TEST_CASE("a permutation visits every index once, for every size") {
  for (std::uint64_t size = 1; size <= 300; ++size) {
    const Permutation order(size, size);
    std::vector<int> met(size);
    for (std::uint64_t index = 0; index < size; ++index) ++met.at(order(index));
    CHECK(met == std::vector<int>(size, 1));
  }
}

// ---- Random positions

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
    auto loops = read_loops(options.truth);
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
