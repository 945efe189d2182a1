// SPDX-License-Identifier: Apache-2.0
// Scans of scenes, and their true loops, whose outlines are computed by hand. And both kinds of scans by the
// commands.
#include "bench/synth/scan.hpp"

#include "bench/evaluation/loops_reader.hpp"
#include "bench/synth/arithmetic.hpp"
#include "bench/synth/scanner.hpp"
#include "tests/bench/made.hpp"
#include "tests/support/run_program.hpp"

using namespace lacuna;
using namespace lacuna::synth;

namespace {

constexpr std::size_t kStride = 12 + 1 + 4;

ScanOptions small(const ScratchFolder& folder, SceneKind scene = SceneKind::kRoom) {
  return {.out = folder / "made.ply", .scene = scene, .points = 20'000};
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
  CHECK(fnv1a(read_file(folder / "made.loops.txt")) == 0x9e7deaaebe22f61eu);
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
    const synth::Made made = write_scan(options);
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
  const auto exact = rows(0), moved = rows(0.05);
  REQUIRE(exact.size() == moved.size());
  std::size_t far = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Vec3 from = place(exact[i]), to = place(moved[i]);
    if (at<std::uint8_t>(exact[i], 24) == 0) {
      CHECK(distance(from, to) == 0);
      continue;
    }
    far += distance(from, to) > 0.01;
    CHECK(distance(from, to) < 0.4);
    CHECK(distance(to, place(moved.back())) == Approx(distance(from, place(exact.back()))).margin(1e-9));
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

// ---- The true loops

namespace {

// A hall without a hole, 6 x 4 x 3 metres, with one place for stations.
Scene closed_room(Vec3 eye) {
  Scene scene;
  constexpr Vec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};
  scene.walls.push_back({{0, 0, 0}, kX, kY, 6, 4, 0.8, {}, "floor"});
  scene.walls.push_back({{0, 0, 3}, kX, kY, 6, 4, 0.8, {}, "ceiling"});
  scene.walls.push_back({{0, 0, 0}, kX, kZ, 6, 3, 0.8, {}});
  scene.walls.push_back({{0, 4, 0}, kX, kZ, 6, 3, 0.8, {}});
  scene.walls.push_back({{0, 0, 0}, kY, kZ, 4, 3, 0.8, {}});
  scene.walls.push_back({{6, 0, 0}, kY, kZ, 4, 3, 0.8, {}});
  scene.stand_low = scene.stand_high = eye;
  return scene;
}

// One station with the whole sphere in view.
ScanOptions whole_sphere(const ScratchFolder& folder) {
  return {.out = folder / "made.ply", .points = 100'000, .stations = 1, .field_of_view = {-90, 90}};
}

struct Scanned {
  std::vector<Position> points;
  std::vector<matching::LoopIds> loops, narrow, steps;
  std::vector<std::string> names;  // of loops
  double step;                     // radians between rays
};

Scanned make(const ScanOptions& options, const Scene& scene) {
  const synth::Made summary = write_scan(options, scene);
  Scanned made{.points = positions_of(options.out, kStride)};
  evaluation::TrueRows rows = evaluation::read_true_rows(summary.truth);
  for (auto& loop : rows.loops) {
    (loop.is_narrow ? made.narrow : made.loops).push_back(std::move(loop.ids));
    if (!loop.is_narrow) made.names.push_back(std::move(loop.name));
  }
  made.steps = std::move(rows.steps);
  REQUIRE(made.loops.size() == summary.loops);
  const double turns = (options.field_of_view[1] - options.field_of_view[0]) / 360;
  made.step = kTwoPi * std::sqrt(turns * options.stations / static_cast<double>(summary.rays));
  return made;
}

Vec3 vec(const Position& p) {
  return {p[0], p[1], p[2]};
}

double to_edge(Vec3 p, Vec3 a, Vec3 b) {
  const double share = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
  return distance(p, a + share * (b - a));
}

double to_outline(Vec3 p, const std::vector<Vec3>& outline) {
  double least = 1e9;
  for (std::size_t i = 0; i < outline.size(); ++i)
    least = std::min(least, to_edge(p, outline[i], outline[(i + 1) % outline.size()]));
  return least;
}

std::vector<Vec3> vertices(const Scanned& made, std::size_t loop) {
  std::vector<Vec3> all;
  for (const std::uint64_t id : made.loops[loop]) all.push_back(vec(made.points[id]));
  return all;
}

// Both curves stay within two spacings of each other. The spacing is that of rays that reach a surface at
// this least cosine.
void check_follows(const Scanned& made, std::size_t loop, const std::vector<Vec3>& outline, Vec3 eye,
                   double cosine) {
  const std::vector<Vec3> found = vertices(made, loop);
  const auto tolerance = [&](Vec3 p) { return 2 * distance(p, eye) * made.step / cosine; };
  for (const Vec3 p : found) CHECK(to_outline(p, outline) < tolerance(p));
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (double share = 0; share < 1; share += 0.05) {
      const Vec3 p = outline[i] + share * (outline[(i + 1) % outline.size()] - outline[i]);
      CHECK(to_outline(p, found) < tolerance(p));
    }
  }
}

double perimeter(const std::vector<Vec3>& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    sum += distance(outline[(i + 1) % outline.size()], outline[i]);
  return sum;
}

}  // namespace

TEST_CASE("a closed room has no true loop") {
  const ScratchFolder folder;
  CHECK(make(whole_sphere(folder), closed_room({2.5, 2, 1.5})).loops.empty());
}

TEST_CASE("a window is the one true loop of its room, along its edge") {
  const ScratchFolder folder;
  const Vec3 eye{2.5, 2, 1.5};
  Scene scene = closed_room(eye);
  scene.walls[2].openings.push_back({2, 1, 3.2, 2, Opening::kGlass});
  const Scanned made = make(whole_sphere(folder), scene);
  REQUIRE(made.loops.size() == 1);
  CHECK(made.names[0] == "window");
  const std::vector<Vec3> edge{{2, 0, 1}, {3.2, 0, 1}, {3.2, 0, 2}, {2, 0, 2}};
  check_follows(made, 0, edge, eye, 0.8);
  CHECK(perimeter(vertices(made, 0)) == Approx(4.4).epsilon(0.1));
}

TEST_CASE("a window counts from four spacings on, and is a narrow hole from two spacings on") {
  const ScratchFolder folder;
  const double spacing = 2 * kTwoPi * std::sqrt(0.5 / 100'000);
  const auto loops = [&](double width) {
    Scene scene = closed_room({2.5, 2, 1.5});
    const double half = width * spacing / 2;
    scene.walls[2].openings.push_back({2.5 - half, 1, 2.5 + half, 2, Opening::kGlass});
    const Scanned made = make(whole_sphere(folder), scene);
    for (const auto& loop : made.narrow) CHECK(loop.size() > 30);  // a metre high
    return std::pair(made.loops.size(), made.narrow.size());
  };
  CHECK(loops(1.5) == std::pair<std::size_t, std::size_t>(0, 0));
  CHECK(loops(3.5) == std::pair<std::size_t, std::size_t>(0, 1));
  CHECK(loops(8) == std::pair<std::size_t, std::size_t>(1, 0));
}

TEST_CASE("a box on the floor has one true loop: its shadow's outline, and the edges where it turns away") {
  const ScratchFolder folder;
  const Vec3 eye{1, 2, 1.5};
  Scene scene = closed_room(eye);
  scene.boxes.push_back({{3, 2, 0.25}, {0.25, 0.25, 0.25}, 1, 0, 0.8, "crate"});
  const Scanned made = make(whole_sphere(folder), scene);
  REQUIRE(made.loops.size() == 1);
  CHECK(made.names[0] == "shadow of crate");
  // The eye is three times as high as the lid: shadows lie 1.5 times as far away as what casts them.
  const std::vector<Vec3> outline{{2.75, 1.75, 0},   {3.625, 1.625, 0}, {4.375, 1.625, 0}, {4.375, 2.375, 0},
                                  {3.625, 2.375, 0}, {2.75, 2.25, 0},   {2.75, 2.25, 0.5}, {3.25, 2.25, 0.5},
                                  {3.25, 1.75, 0.5}, {2.75, 1.75, 0.5}};
  check_follows(made, 0, outline, eye, 1.5 / std::sqrt(1.5 * 1.5 + 3.4 * 3.4));
  CHECK(perimeter(vertices(made, 0)) == Approx(perimeter(outline)).epsilon(0.1));
}

TEST_CASE("a ball in the air has two true loops: where it turns away, and its shadow on the wall") {
  const ScratchFolder folder;
  const Vec3 eye{1, 2, 1.5};
  Scene scene = closed_room(eye);
  scene.balls.push_back({{3, 2, 1.5}, 0.3, 0.8});
  const Scanned made = make(whole_sphere(folder), scene);
  REQUIRE(made.loops.size() == 2);
  std::set<std::string> names(made.names.begin(), made.names.end());
  CHECK(names == std::set<std::string>{"edge of ball", "shadow of ball"});
  const double sine = 0.3 / 2;  // of half the angle under which the ball appears
  const double radius = 5 * sine / std::sqrt(1 - sine * sine);
  for (std::size_t loop = 0; loop < 2; ++loop) {
    if (made.names[loop] != "shadow of ball") continue;
    for (const Vec3 p : vertices(made, loop)) {
      CHECK(p.x == Approx(6).margin(0.02));
      CHECK(std::hypot(p.y - 2, p.z - 1.5) == Approx(radius).margin(2 * 5.1 * made.step));
    }
  }
}

TEST_CASE("circles below and above the scanner have the radius that the field of view gives") {
  const ScratchFolder folder;
  const Vec3 eye{2.5, 2, 1.8};
  ScanOptions options = whole_sphere(folder);
  const auto check_circle = [&](double low, double high, const char* name, double radius) {
    options.field_of_view = {low, high};
    const Scanned made = make(options, closed_room(eye));
    REQUIRE(made.loops.size() == 1);
    CHECK(made.names[0] == name);
    REQUIRE(made.loops[0].size() > 50);
    for (const Vec3 p : vertices(made, 0)) {
      const double off = std::hypot(p.x - eye.x, p.y - eye.y) - radius;
      CHECK(off > -0.01);
      CHECK(off < 2 * 2.1 * made.step / 0.8);
    }
  };
  check_circle(-60, 90, "tripod circle of station 0", 1.8 * std::tan(kTwoPi / 12));
  check_circle(-90, 65, "zenith circle of station 0", 1.2 * std::tan(kTwoPi * 25 / 360));
}

TEST_CASE("a tripod circle that another station samples sparsely is a step of density, and no true loop") {
  const ScratchFolder folder;
  ScanOptions options = whole_sphere(folder);
  options.field_of_view = {-60, 90};
  Scene scene = closed_room({1, 2, 1.5});
  scene.stand_high.x = 5;
  const Scanned alone = make(options, scene);
  CHECK(alone.loops.size() == 1);
  CHECK(alone.steps.empty());
  options.stations = 2;
  options.seed = 9;
  const std::vector<Vec3> eyes = Scanner(options, scene).stations();
  REQUIRE(std::fabs(eyes[0].x - eyes[1].x) > 3);  // so that no place lies in both circles
  const Scanned made = make(options, scene);
  CHECK(made.loops.empty());
  REQUIRE(made.steps.size() == 2);
  std::set<std::size_t> found;
  for (const auto& step : made.steps) {
    CHECK(step.size() > 50);
    CHECK(step.front() == step.back());
    const Vec3 first = vec(made.points[step[0]]);
    const std::size_t station = std::fabs(first.x - eyes[0].x) < std::fabs(first.x - eyes[1].x) ? 0 : 1;
    found.insert(station);
    for (const std::uint64_t id : step) {
      const Vec3 p = vec(made.points[id]);
      const double radius = std::hypot(p.x - eyes[station].x, p.y - eyes[station].y);
      CHECK(radius == Approx(1.5 * std::tan(kTwoPi / 12)).margin(0.05));
    }
  }
  CHECK(found.size() == 2);
}

namespace {

// Level ground of 100 by 80 metres, seen from one strip.
Scene level_ground() {
  Scene scene;
  scene.terrains.push_back({.length = 100, .width = 80, .reflectance = 0.5});
  scene.stand_high = {100, 80, 0};
  scene.flown = true;
  return scene;
}

ScanOptions one_strip(const ScratchFolder& folder) {
  return {.out = folder / "made.ply", .points = 30'000, .stations = 1};
}

std::multiset<std::string> names_in(const Scanned& made) {
  return {made.names.begin(), made.names.end()};
}

}  // namespace

TEST_CASE("a house has two true loops from the air, around its roof and on the ground around it") {
  for (const double y : {40, 70}) {  // below the strip, and to a side, where one wall has points
    const ScratchFolder folder;
    Scene scene = level_ground();
    scene.houses.push_back({{50, y, -2}, 8, 6, 8, y == 40 ? 3.0 : 0.0, 1, 0, 0.5});
    const Scanned made = make(one_strip(folder), scene);
    REQUIRE(names_in(made) ==
            std::multiset<std::string>{"edge of ground", "edge of house", "shadow of house"});
    for (std::size_t loop = 0; loop < 3; ++loop) {
      if (made.names[loop] == "edge of house")
        CHECK(perimeter(vertices(made, loop)) == Approx(56).epsilon(0.15));
    }
  }
}

TEST_CASE("true loops of every scene are closed, simple and in canonical form, and say what they are") {
  for (const SceneKind scene : kAllScenes) {
    const ScratchFolder folder;
    ScanOptions options = {.out = folder / "made.ply", .scene = scene, .points = 50'000};
    const Scanned made = make(options, make_scene(scene));
    CHECK(made.loops.size() > 8);
    CHECK(std::is_sorted(made.loops.begin(), made.loops.end()));
    for (const auto& loop : made.loops) {
      REQUIRE(loop.size() >= 12);
      CHECK(*std::min_element(loop.begin(), loop.end()) == loop.front());
      CHECK(loop[1] < loop.back());
      CHECK(std::set<std::uint64_t>(loop.begin(), loop.end()).size() == loop.size());
      CHECK(*std::max_element(loop.begin(), loop.end()) < made.points.size());
    }
    for (const std::string& name : made.names) CHECK(!name.empty());
    const char* const opening = scene == SceneKind::kAerial ? "water" : "window";
    CHECK(std::count(made.names.begin(), made.names.end(), opening) >= 2);
  }
}

TEST_CASE("random order gives the same true loops") {
  const ScratchFolder folder;
  ScanOptions options = {.out = folder / "made.ply", .points = 30'000};
  const Scene scene = make_scene(options.scene);
  const Scanned first = make(options, scene);
  options.order = Order::kRandom;
  const Scanned shuffled = make(options, scene);
  CHECK(places_of(shuffled.loops, shuffled.points) == places_of(first.loops, first.points));
}

TEST_CASE("noise and errors of registration do not change true loops, and strays are on none") {
  const ScratchFolder folder;
  ScanOptions options = {.out = folder / "made.ply", .points = 30'000, .stations = 3};
  const Scene scene = make_scene(options.scene);
  options.noise = 0;
  const Scanned clean = make(options, scene);
  options.noise = 0.02;
  options.registration = 0.05;
  CHECK(make(options, scene).loops == clean.loops);
  options.noise = options.registration = 0;
  options.outliers = 0.1;
  const Scanned strayed = make(options, scene);
  CHECK(double(strayed.loops.size()) == Approx(double(clean.loops.size())).margin(1));
  for (const auto& loop : strayed.loops)
    for (const std::uint64_t id : loop) CHECK(strayed.points[id] == clean.points[id]);
}

// ---- The commands

namespace {

// `arguments` are divided by blanks.
void run(const std::string& command, const std::string& out, const std::string& arguments) {
  std::vector<std::string> words = {"synth", command, out, "--truth", out + ".txt"};
  std::istringstream in(arguments);
  for (std::string word; in >> word;) words.push_back(word);
  test::succeed(words, test::Program::kBench);
}

}  // namespace

TEST_CASE("the synth command makes what the options say") {
  const ScratchFolder folder;
  const std::string out = (folder / "made.ply").string();
  run("surface", out,
      "--kind sphere-cap --points 10000 --holes 2 --hole-radius 3 5 --jitter 0.1 --noise 0.1"
      " --spacing 1 --density-factor 2 --order random --seed 9 --translate -5 0 7 --double");
  SurfaceOptions options{.out = folder / "again.ply",
                         .kind = SurfaceKind::kSphereCap,
                         .points = 10'000,
                         .spacing = 1,
                         .holes = 2,
                         .hole_radius = {3, 5},
                         .jitter = 0.1,
                         .noise = 0.1,
                         .density_factor = 2,
                         .order = Order::kRandom,
                         .seed = 9,
                         .translate = {-5, 0, 7},
                         .coordinates = Coordinates::kDouble};
  write_surface(options);
  CHECK(read_file(out) == read_file(options.out));
  CHECK(read_loops(out + ".txt") == read_loops(folder / "again.loops.txt"));
  CHECK(folder.names().size() == 4);

  run("surface", out, "--points 10000 --holes 2 --positions random");
  options = {.out = options.out, .points = 10'000, .holes = 2, .positions = PositionKind::kRandom};
  write_surface(options);
  CHECK(read_file(out) == read_file(options.out));

  run("scan", out,
      "--scene hall --points 5000 --stations 3 --noise 0.01 --outliers 0.1 --max-range 20"
      " --registration 0.03 --ring-ratio 4 --field-of-view -30 60 --sweeps 2 --station-factor 3");
  CHECK(rows_of(out, 17).size() == Approx(5000).epsilon(0.1));
  const ScanOptions scan{.out = options.out,
                         .scene = SceneKind::kHall,
                         .points = 5000,
                         .stations = 3,
                         .station_factor = 3,
                         .sweeps = 2,
                         .noise = 0.01,
                         .outliers = 0.1,
                         .registration = 0.03,
                         .max_range = 20,
                         .ring_ratio = 4,
                         .field_of_view = {-30, 60}};
  write_scan(scan);
  CHECK(read_file(out) == read_file(scan.out));
  CHECK(read_loops(out + ".txt") == read_loops(folder / "again.loops.txt"));
}
