// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scanner.hpp"
#include "bench/synth/trig.hpp"
#include "tests/bench/synth/made.hpp"

using namespace lacuna;
using namespace lacuna::synth;

namespace {

constexpr std::size_t kStride = 12 + 1 + 4;

ScanOptions small(const ScratchFolder& folder, SceneKind scene = SceneKind::kRoom) {
  ScanOptions options;
  options.out = folder / "made.ply";
  options.scene = scene;
  options.points = 20'000;
  return options;
}

}  // namespace

TEST_CASE("a ray hits the nearest of a wall, a box, a ball and a column, at the right angle") {
  Scene scene;
  scene.walls.push_back({{10, -5, -5}, {0, 1, 0}, {0, 0, 1}, 10, 10, 0.8, {{4, 4, 5, 5, Opening::kGlass}}});
  const double slant = std::sqrt(0.5);
  CHECK(cast(scene, {{0, 2, 0}, {1, 0, 0}}).range == Approx(10));
  CHECK(cast(scene, {{0, 2, 0}, {1, 0, 0}}).cosine == Approx(1));
  CHECK(cast(scene, {{7, 0, 1}, {slant, slant, 0}}).range == Approx(3 / slant));
  CHECK(cast(scene, {{7, 0, 1}, {slant, slant, 0}}).cosine == Approx(slant));
  CHECK(cast(scene, {{0, -0.5, -0.5}, {1, 0, 0}}).reflectance == 0);  // glass
  CHECK(std::isinf(cast(scene, {{0, 2, 0}, {-1, 0, 0}}).range));
  scene.boxes.push_back({{8, 2, 0}, {1, 1, 1}, 0.6, 0.8, 0.5});
  CHECK(cast(scene, {{0, 2, 0}, {1, 0, 0}}).range == Approx(8 - 1 / 0.8));
  CHECK(cast(scene, {{0, 2, 0}, {1, 0, 0}}).cosine == Approx(0.8));
  scene.balls.push_back({{5, 2, 0}, 1, 0.5});
  CHECK(cast(scene, {{0, 2, 0}, {1, 0, 0}}).range == Approx(4));
  scene.columns.push_back({{3, 2, -1}, 0.5, 2, 0.5});
  CHECK(cast(scene, {{0, 2, 0}, {1, 0, 0}}).range == Approx(2.5));
  CHECK(cast(scene, {{0, 2, 1.5}, {1, 0, 0}}).range == Approx(10));  // over the column
  CHECK(cast(scene, {{3, 2.2, 4}, {0, 0, -1}}).range == Approx(3));  // its lid
}

TEST_CASE(
    "a scan and its true loops have the bytes that they had on the machine where this test was written") {
  const ScratchFolder folder;
  const auto hash = [&](SceneKind scene, Order order) {
    ScanOptions options = small(folder, scene);
    options.order = order;
    options.stations = 3;
    options.outliers = 0.01;
    write_scan(options);
    return fnv1a(read_file(options.out));
  };
  CHECK(hash(SceneKind::kRoom, Order::kScanline) == 0x25d59ce3a4bffc8du);
  CHECK(hash(SceneKind::kCourt, Order::kRandom) == 0x3aa0958aba795917u);
  CHECK(hash(SceneKind::kHall, Order::kScanline) == 0x8db3d5542b4e6719u);
  CHECK(fnv1a(lines_without({"#step ", "#narrow "}, read_file(folder / "made.loops.txt"))) ==
        0x75acfa9cc7674a91u);
  CHECK(hash(SceneKind::kVault, Order::kScanline) == 0x41896b837057aafbu);
  CHECK(hash(SceneKind::kStreet, Order::kScanline) == 0x5f27a7eb5ccbb76au);
  CHECK(hash(SceneKind::kPlant, Order::kScanline) == 0x9829e56d3e014692u);
  CHECK(hash(SceneKind::kAerial, Order::kScanline) == 0x0be3a0a91a4acb12u);
}

TEST_CASE("a scan has about the wanted number of points, of every station, with intensities in range") {
  for (const SceneKind scene : kAllScenes) {
    const ScratchFolder folder;
    ScanOptions options = small(folder, scene);
    options.stations = 4;
    const ScanSummary made = write_scan(options);
    const auto rows = rows_of(options.out, kStride);
    CHECK(rows.size() == made.points);
    CHECK(made.rays > made.points);
    CHECK(double(made.points) == Approx(20'000).epsilon(0.05));
    std::array<std::size_t, 4> of_station{};
    for (const std::string& row : rows) {
      ++of_station.at(at<std::uint8_t>(row, 12));
      const auto intensity = at<float>(row, 13);
      CHECK((intensity > 0 && intensity <= 1));
    }
    for (const std::size_t count : of_station) CHECK(count > 2500);
  }
}

TEST_CASE("the first station has so many times the points of each other one") {
  const ScratchFolder folder;
  ScanOptions options = small(folder, SceneKind::kHall);
  options.stations = 3;
  options.station_factor = 6;
  CHECK(double(write_scan(options).points) == Approx(20'000).epsilon(0.05));
  std::array<double, 3> of_station{};
  for (const std::string& row : rows_of(options.out, kStride)) ++of_station.at(at<std::uint8_t>(row, 12));
  CHECK(of_station[0] / of_station[1] == Approx(6).epsilon(0.1));
  CHECK(of_station[1] / of_station[2] == Approx(1).epsilon(0.1));
}

TEST_CASE("an error of registration moves each station after the first as one rigid body") {
  const ScratchFolder folder;
  ScanOptions options = small(folder);
  options.coordinates = Coordinates::kDouble;
  const auto rows = [&](double registration) {
    options.registration = registration;
    write_scan(options);
    return rows_of(options.out, 24 + 1 + 4);
  };
  const auto place = [](const std::string& row) {
    return Vec3{at<double>(row, 0), at<double>(row, 8), at<double>(row, 16)};
  };
  const auto apart = [](Vec3 a, Vec3 b) { return std::sqrt(dot(b - a, b - a)); };
  const auto exact = rows(0), moved = rows(0.05);
  REQUIRE(exact.size() == moved.size());
  std::size_t far = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Vec3 from = place(exact[i]), to = place(moved[i]);
    if (at<std::uint8_t>(exact[i], 24) == 0) {
      CHECK(apart(from, to) == 0);
      continue;
    }
    far += apart(from, to) > 0.01;
    CHECK(apart(from, to) < 0.4);
    CHECK(apart(to, place(moved.back())) == Approx(apart(from, place(exact.back()))).margin(1e-9));
  }
  CHECK(far > 5000);
}

TEST_CASE("scans that cannot be made are refused in one line and leave no file") {
  const ScratchFolder folder;
  const auto refused = [&](auto change) { check_refused(folder, small(folder), write_scan, change); };
  refused([](ScanOptions& o) { o.points = 0; });
  refused([](ScanOptions& o) { o.stations = 0; });
  refused([](ScanOptions& o) { o.stations = 256; });
  refused([](ScanOptions& o) { o.noise = -0.1; });
  refused([](ScanOptions& o) { o.outliers = std::nan(""); });
  refused([](ScanOptions& o) { o.max_range = 0; });
  refused([](ScanOptions& o) { o.registration = -0.1; });
  refused([](ScanOptions& o) { o.ring_ratio = 0; });
  refused([](ScanOptions& o) { o.ring_ratio = std::nan(""); });
  refused([](ScanOptions& o) { o.field_of_view = {30, 30}; });
  refused([](ScanOptions& o) { o.field_of_view = {-91, 30}; });
  refused([](ScanOptions& o) { o.station_factor = 0; });
  refused([](ScanOptions& o) { o.sweeps = 0; });
  refused([](ScanOptions& o) { o.sweeps = 9; });
  refused([](ScanOptions& o) { o.scene = SceneKind::kAerial, o.sweeps = 2; });
  refused([](ScanOptions& o) { o.scene = SceneKind::kAerial, o.field_of_view = {-30, 30}; });
  refused([](ScanOptions& o) { o.translate = {1e6, 0, 0}; });  // in floats
  refused([](ScanOptions& o) { o.out = o.out / "no-such-folder" / "made.ply"; });
}
