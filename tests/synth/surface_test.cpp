#include "engine/core/error.hpp"
#include "tests/synth/made.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <catch2/catch.hpp>

using namespace lacuna;
using namespace lacuna::synth;

namespace {

SurfaceOptions small(const Folder& folder, SurfaceKind kind = SurfaceKind::kPlane) {
  SurfaceOptions options;
  options.out = folder / "made.ply";
  options.truth = folder / "made.loops.txt";
  options.kind = kind;
  options.points = 20'000;
  options.holes = 5;
  options.hole_radius = {3, 7};
  return options;
}

std::size_t rims_of(SurfaceKind kind) {
  if (kind == SurfaceKind::kTorus) return 0;
  return kind == SurfaceKind::kCylinder ? 2 : 1;
}

const auto kAllKinds = {SurfaceKind::kPlane, SurfaceKind::kWaves, SurfaceKind::kCylinder, SurfaceKind::kTorus,
                        SurfaceKind::kSphereCap};

// Kilobytes of a field of /proc/self/status.
long status_kilobytes(const std::string& field) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(field)) return std::stol(line.substr(field.size()));
  return 0;
}

}  // namespace

TEST_CASE("a surface of the same seed has the same bytes, of another seed other bytes") {
  Folder folder;
  SurfaceOptions options = small(folder);
  write_surface(options);
  const std::string first = bytes_of(options.out);
  write_surface(options);
  CHECK(bytes_of(options.out) == first);
  options.seed = 2;
  write_surface(options);
  CHECK(bytes_of(options.out) != first);
}

TEST_CASE("a surface has the bytes that it had on the machine where this test was written") {
  Folder folder;
  const auto hash = [&](SurfaceKind kind, Order order) {
    SurfaceOptions options = small(folder, kind);
    options.order = order;
    options.noise = 0.2;
    options.density_factor = 3;
    write_surface(options);
    return fnv1a(bytes_of(options.out) + bytes_of(options.truth));
  };
  CHECK(hash(SurfaceKind::kPlane, Order::kScanline) == 0x04c4665fbb35768eu);
  CHECK(hash(SurfaceKind::kWaves, Order::kRandom) == 0x7af4096c3f95e1f9u);
  CHECK(hash(SurfaceKind::kCylinder, Order::kRandom) == 0xff7fb20dcbc4a686u);
  CHECK(hash(SurfaceKind::kTorus, Order::kScanline) == 0x9818274b4341e311u);
  CHECK(hash(SurfaceKind::kSphereCap, Order::kScanline) == 0x4b9de0821496cf48u);
}

TEST_CASE("every planted hole and every rim is one closed true loop in canonical form") {
  for (const SurfaceKind kind : kAllKinds)
    for (const Order order : {Order::kScanline, Order::kRandom}) {
      Folder folder;
      SurfaceOptions options = small(folder, kind);
      options.order = order;
      const SurfaceSummary made = write_surface(options);
      const auto points = positions_of(options.out);
      const auto loops = loops_of(options.truth);
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
      CHECK(widest < 3 * options.spacing);
    }
}

TEST_CASE("the true loops are the edges with exactly one whole quad, all of them") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    Folder folder;
    SurfaceOptions options = small(folder);
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
    for (const auto& loop : loops_of(options.truth))
      for (std::size_t i = 0; i < loop.size(); ++i)
        CHECK(found.insert({nodes.at(loop[i]), nodes.at(loop[(i + 1) % loop.size()])}).second);
    CHECK(found == expected);
  }
}

TEST_CASE("inside a true loop on a plane there is no point, and just outside there are") {
  Folder folder;
  SurfaceOptions options = small(folder);
  options.jitter = 0;
  write_surface(options);
  const auto points = positions_of(options.out);
  auto loops = loops_of(options.truth);
  std::sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  loops.pop_back();  // the rim
  for (const auto& loop : loops) {
    const std::set<std::uint64_t> on_loop(loop.begin(), loop.end());
    std::size_t inside = 0, beside = 0;
    for (std::uint64_t id = 0; id < points.size(); ++id) {
      if (on_loop.contains(id)) continue;
      bool within = false;
      double nearest = 1e30;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Position& p = points[id];
        const Position& a = points[loop[i]];
        const Position& b = points[loop[(i + 1) % loop.size()]];
        if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
          within = !within;
        nearest = std::min(nearest, distance(p, a));
      }
      inside += within;
      beside += nearest < 1.1 * options.spacing;
    }
    CHECK(inside == 0);
    CHECK(beside > loop.size() / 2);
  }
}

TEST_CASE("many small holes give as many loops, none of which touch") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Folder folder;
    SurfaceOptions options = small(folder, SurfaceKind::kTorus);
    options.points = 600'000;
    options.holes = 1000;
    options.hole_radius = {1.5, 3};
    options.seed = seed;
    write_surface(options);
    std::set<std::uint64_t> seen;
    std::size_t nodes = 0;
    const auto loops = loops_of(options.truth);
    for (const auto& loop : loops) {
      seen.insert(loop.begin(), loop.end());
      nodes += loop.size();
    }
    CHECK(loops.size() == 1000);
    CHECK(seen.size() == nodes);
  }
}

TEST_CASE("random order has the points of scanline order, in another order") {
  Folder folder;
  SurfaceOptions options = small(folder, SurfaceKind::kWaves);
  write_surface(options);
  auto in_scanlines = positions_of(options.out);
  const auto loops_in_scanlines = loops_of(options.truth);
  options.order = Order::kRandom;
  write_surface(options);
  auto at_random = positions_of(options.out);
  CHECK(in_scanlines != at_random);

  const auto lengths = [](const auto& loops, const std::vector<Position>& points) {
    std::multiset<std::set<Position>> all;
    for (const auto& loop : loops) {
      std::set<Position> places;
      for (const std::uint64_t id : loop) places.insert(points[id]);
      all.insert(places);
    }
    return all;
  };
  CHECK(lengths(loops_in_scanlines, in_scanlines) == lengths(loops_of(options.truth), at_random));
  std::sort(in_scanlines.begin(), in_scanlines.end());
  std::sort(at_random.begin(), at_random.end());
  CHECK(in_scanlines == at_random);
}

TEST_CASE("past the density step there is the promised part of the points, and the holes are before it") {
  for (const std::uint32_t step : {4u, 9u}) {
    Folder folder;
    SurfaceOptions options = small(folder);
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
    const auto loops = loops_of(options.truth);
    CHECK(loops.size() == 4);
    std::size_t past = 0;
    for (const auto& loop : loops)
      past += std::any_of(loop.begin(), loop.end(),
                          [&](std::uint64_t id) { return points[id][0] > 0.5 * width; });
    CHECK(past == 1);  // the rim
  }
}

TEST_CASE("a density step on closed surfaces leaves no further loops") {
  for (const SurfaceKind kind : kAllKinds) {
    Folder folder;
    SurfaceOptions options = small(folder, kind);
    options.density_step = 4;
    write_surface(options);
    const auto points = positions_of(options.out);
    const auto loops = loops_of(options.truth);
    CHECK(loops.size() == 5 + rims_of(kind));
    for (const auto& loop : loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        CHECK(distance(points[loop[i]], points[loop[(i + 1) % loop.size()]]) < 6 * options.spacing);
  }
}

TEST_CASE("the density factor is the ratio of the densities at two corners") {
  Folder folder;
  SurfaceOptions options = small(folder);
  options.points = 200'000;
  options.holes = 0;
  options.density_factor = 9;
  write_surface(options);
  const auto points = positions_of(options.out);
  Position far{};
  for (const Position& p : points)
    for (int axis : {0, 1}) far[axis] = std::max(far[axis], p[axis]);
  double dense = 0, sparse = 0;
  for (const Position& p : points) {
    dense += p[0] < 0.03 * far[0] && p[1] < 0.03 * far[1];
    sparse += p[0] > 0.97 * far[0] && p[1] > 0.97 * far[1];
  }
  CHECK(dense / sparse > 7);
  CHECK(dense / sparse < 10);
}

TEST_CASE("noise is along the normal and has the deviation asked for") {
  Folder folder;
  SurfaceOptions options = small(folder);
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
  Folder folder;
  SurfaceOptions options = small(folder, SurfaceKind::kTorus);
  options.points = 2'000'000;
  options.holes = 100;
  options.order = Order::kRandom;
  std::ofstream("/proc/self/clear_refs") << 5;  // resets the peak
  const long before = status_kilobytes("VmRSS:");
  write_surface(options);
  CHECK(status_kilobytes("VmHWM:") - before < 32 * 1024);
}

TEST_CASE("surfaces that cannot be made are refused in one line and leave no file") {
  Folder folder;
  const auto refused = [&](auto change) {
    SurfaceOptions options = small(folder);
    change(options);
    std::string reason;
    try {
      write_surface(options);
    } catch (const Error& error) {
      reason = error.what();
    }
    CHECK(!reason.empty());
    CHECK(reason.find('\n') == std::string::npos);
    CHECK(folder.files() == 0);
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
  refused([](SurfaceOptions& o) { o.translate = {1e6, 0, 0}; });  // in floats
  refused([](SurfaceOptions& o) { o.truth = o.out; });
  refused([](SurfaceOptions& o) { o.out = o.out / "no-such-folder" / "made.ply"; });
}

TEST_CASE("a full disk is an error that names file and reason, and no surface appears") {
  Folder folder;
  const SurfaceOptions options = small(folder);
  std::filesystem::create_symlink("/dev/full", options.out.string() + ".partial");
  CHECK_THROWS_WITH(write_surface(options), Catch::Contains("made.ply") && Catch::Contains("No space left"));
  CHECK(folder.files() == 0);
}
