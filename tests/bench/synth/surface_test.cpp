// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/synth/made.hpp"

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
    // As the truth was before its loops had names.
    return fnv1a(read_file(options.out) +
                 lines_without({"# hole", "# outer edge"}, read_file(options.truth)));
  };
  CHECK(hash(SurfaceKind::kPlane, Order::kScanline) == 0x04c4665fbb35768eu);
  CHECK(hash(SurfaceKind::kWaves, Order::kRandom) == 0x7af4096c3f95e1f9u);
  CHECK(hash(SurfaceKind::kCylinder, Order::kRandom) == 0xff7fb20dcbc4a686u);
  CHECK(hash(SurfaceKind::kTorus, Order::kScanline) == 0x9818274b4341e311u);
  CHECK(hash(SurfaceKind::kSphereCap, Order::kScanline) == 0x4b9de0821496cf48u);
  CHECK(hash(SurfaceKind::kSphere, Order::kRandom) == 0xe52e054e9a81dc15u);
  CHECK(hash(SurfaceKind::kCube, Order::kScanline) == 0x7d417f894d909c2au);
  CHECK(hash(SurfaceKind::kWaves, Order::kScanline, PositionKind::kRandom) == 0x7cd9b3d156d856bdu);
  CHECK(hash(SurfaceKind::kTorus, Order::kRandom, PositionKind::kRandom) == 0x5bd12665ec7b503au);
  CHECK(hash(SurfaceKind::kSphere, Order::kScanline, PositionKind::kRandom) == 0x31666ed3485e1f4bu);
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
      const auto loops = loops_of(options.truth);
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
