// SPDX-License-Identifier: Apache-2.0
// Stations: lists of them, what each has seen, what is up, and where to stand next.
#include "io/explain/stations/directions.hpp"
#include "io/explain/stations/next_stations.hpp"
#include "io/explain/stations/scan_axes.hpp"
#include "io/explain/stations/station.hpp"
#include "io/explain/stations/station_views.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"

#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

// ---- One station

const std::vector<fs::path> kFiles = {"survey/a.laz", "survey/b.laz", "old/a.laz"};

// The first file alone has no numbers.
std::vector<RowLayout> layouts() {
  std::vector<RowLayout> all(kFiles.size());
  for (std::size_t i = 1; i < all.size(); ++i) all[i].properties = {{"point_source_id", Scalar::kUint16, 0}};
  return all;
}

std::vector<Station> read(const ScratchFolder& folder, const std::string& text) {
  return read_stations(folder.write("stations.txt", text), kFiles, layouts());
}

TEST_CASE("a file of stations has names, places and what each has measured") {
  const ScratchFolder folder;
  const auto stations = read(folder,
                             "name;x;y;z;file\n"
                             "# a comment\n"
                             "north; 1; -2.5; 3; b.laz\n"
                             "south 4 5 6 old/a.laz 7\r\n"
                             "tower,7,8,9,12\n");
  REQUIRE(stations.size() == 3);
  CHECK(stations[0].name == "north");
  CHECK(stations[0].place == Eigen::Vector3d(1, -2.5, 3));
  CHECK(stations[0].file == std::optional<std::size_t>(1));
  CHECK_FALSE(stations[0].source);
  CHECK(stations[1].file == std::optional<std::size_t>(2));
  CHECK(stations[1].source == std::optional<std::uint32_t>(7));
  CHECK_FALSE(stations[2].file);
  CHECK(stations[2].source == std::optional<std::uint32_t>(12));
  CHECK(read(folder, "only 1 2 3\n").size() == 1);
  const auto unnamed = read(folder, "1,5;2;3\n");
  REQUIRE(unnamed.size() == 1);
  CHECK(unnamed[0].name == "1");
  CHECK(unnamed[0].place == Eigen::Vector3d(1.5, 2, 3));
  CHECK(read(folder, "Name;X;Y;Z\nS1;1,5;2,5;-3,5\n")[0].place == Eigen::Vector3d(1.5, 2.5, -3.5));
  // A whole name, though another file's ends in it.
  const std::vector<fs::path> files = {"old/a.laz", "a.laz"};
  const auto whole = read_stations(folder.write("stations.txt", "south 4 5 6 a.laz\n"), files, layouts());
  REQUIRE(whole.size() == 1);
  CHECK(whole[0].file == std::optional<std::size_t>(1));
}

TEST_CASE("an error in a file of stations names the line and what is needed") {
  const ScratchFolder folder;
  test::check_reasons(
      {{"", "names no station"},
       {"a 1 2\n", "line 1"},
       {"a 1 2 x\n", "is not a number"},
       {"a 1 2 nan\n", "is not a number"},
       {"a 1 2 1e200\n", "line 1: '1e200' is not from -1e+12 to 1e+12"},
       {"1.5 1 2 3 0 0 0 1\n", "a trajectory needs a first line that names its columns"},
       {"a 1 2 3 c.laz\n", "c.laz is not the name of a scan"},
       {"a 1 2 3 a.laz\n", "a.laz is the name of several scans"},
       {"a 1 2 3 4\nb 5 6 7 4\n", "line 2: b has the points of an earlier station"},
       {"a 1 2 3 4 5\n", "4 is not the name of a scan"},
       {"a 1 2 3 b.laz 5 6\n", "are needed"},
       {"a 1 2 3 b.laz a.laz\n", "is no number of a source"},
       {"a 1 2 3 survey/a.laz 4\n", "line 1: a has the number 4, and survey/a.laz has no column scan"}},
      [&](const std::string& text) { return test::error_of([&] { read(folder, text); }); });
  const auto none = [&] { read_stations(folder.write("stations.txt", "a 1 2 3 4\n"), kFiles, {}); };
  CHECK_THAT(test::error_of(none), Contains("line 1: a has the number 4, and no file has a column scan"));
}

TEST_CASE("a range image keeps the nearest range of each direction, and fills gaps as far as wanted") {
  const ScratchFolder folder;
  RangeImage image(folder.path());
  for (std::size_t cell = 0; cell < RangeImage::kCells; cell += 9'973) {
    const Eigen::Vector3d direction = direction_of(cell, RangeImage::kEdge);
    CHECK(direction.norm() == Approx(1));
    CHECK(image.at(direction) == 0);
    CHECK(image.put(3 * direction, 5) == 0);
    CHECK(image.put(direction, 7) == 5);
    CHECK(image.put(direction, 4) == 5);
    CHECK(image.at(2 * direction) == 4);
    CHECK(image.cells()[cell] == 4);
  }
  RangeImage other(folder.path());
  const std::size_t middle = (2 * RangeImage::kEdge + 500) * RangeImage::kEdge + 500;  // of the third face
  other.put(direction_of(middle, RangeImage::kEdge), 2);
  other.put(direction_of(middle + 10, RangeImage::kEdge), 3);
  other.fill(4);
  CHECK(other.cells()[middle + 4] == 2);
  CHECK(other.cells()[middle - 4 * RangeImage::kEdge] == 2);
  CHECK(other.cells()[middle + 5] == 0);
  CHECK(other.cells()[middle + 6] == 3);
  CHECK(other.cells()[middle + 3 + 3 * RangeImage::kEdge] == 0);  // 4.2 cells away
}

// ---- What stations have seen

std::vector<StationSummary> stations_of(std::vector<ScanInput> inputs, const OutputConfig& config = {},
                                        PointsOfNone* of_none = nullptr) {
  const ScratchFolder folder;
  const ScanFiles scan(std::move(inputs), {});
  const auto views = watch_stations(scan, config, folder.path());
  if (!views) return {};
  views->complete(TaskArena(2));
  if (of_none) *of_none = views->points_of_none();
  return views->summaries();
}

TEST_CASE("scans of an E57 file with a pose are stations, with the rows of each") {
  const ScratchFolder folder;
  const auto scan = [](const std::string& pose, const std::vector<double>& x) {
    return test::E57TestScan{.fields = test::e57_position(x, x, x), .pose = pose};
  };
  const std::string file = folder.write(
      "a.e57", test::encode_e57({scan(test::e57_pose({1, 0, 0, 0}, {1, 2, 3}), {1, 2, 3}), scan("", {4}),
                                 scan(test::e57_pose({0, 1, 0, 0}, {7, 8, 9}), {1, 2})}));
  PointsOfNone of_none;
  const auto stations = stations_of({file}, {}, &of_none);
  REQUIRE(stations.size() == 2);  // one has no pose
  CHECK(of_none.points == 1);
  CHECK(of_none.subject == "number 1 of " + file);
  CHECK(stations[0].name == "a 0");
  CHECK(stations[0].place == Eigen::Vector3d(1, 2, 3));
  CHECK(stations[0].points == 3);
  CHECK(stations[1].name == "a 2");
  CHECK(stations[1].place == Eigen::Vector3d(7, 8, 9));
  CHECK(stations[1].points == 2);
  CHECK(stations[1].farthest == Approx(2 * std::sqrt(3)));
}

TEST_CASE("a PCD file with a viewpoint, a PLY file with a camera, and a scan with a pose, are stations") {
  const ScratchFolder folder;
  const std::string pcd = folder.write("a.pcd", test::ascii_pcd("1 2 3\n4 5 6\n", "5 6 7"));
  const std::string text = folder.write("b.xyz", "1 2 3\n");
  const std::string ply =
      folder.write("c.ply", test::ply_header(test::vertices(2) + test::kCamera) + "1 2 3\n4 5 6\n7 8 9\n");
  const auto stations =
      stations_of({pcd, ScanInput(text, parse_pose("10 20 30 0 0 0 1")), ply,
                   ScanInput(folder.write("d.ply", test::read_file(ply)), parse_pose("10 20 30 0 0 0 1"))});
  REQUIRE(stations.size() == 4);
  CHECK(stations[0].place == Eigen::Vector3d(5, 6, 7));
  CHECK(stations[0].points == 2);
  CHECK(stations[1].place == Eigen::Vector3d(10, 20, 30));
  CHECK(stations[2].name == "c");
  CHECK(stations[2].place == Eigen::Vector3d(7, 8, 9));
  CHECK(stations[2].points == 2);
  CHECK(stations[3].place == Eigen::Vector3d(17, 28, 39));
  CHECK(stations_of({text}).empty());
  PointsOfNone of_none;
  CHECK(stations_of({text, pcd}, {}, &of_none).size() == 1);
  CHECK(of_none.points == 1);
  CHECK(of_none.subject == text);
}

TEST_CASE("a file of stations says which rows are whose, and counts rows of none and stations without rows") {
  const ScratchFolder folder;
  const std::string a = folder.write("a.xyz", "x y z scan\n1 0 0 1\n2 0 0 2\n3 0 0 2\n4 0 0 9\n");
  const std::string b = folder.write("b.xyz", "1 1 1\nnan 0 0\n2 2 2\n");
  OutputConfig config;
  config.stations =
      folder.write("stations.txt", "one 0 0 5 1\ntwo 0 0 6 a.xyz 2\nbee 0 0 7 b.xyz\nnone 0 0 8 77\n");
  PointsOfNone of_none;
  const auto stations = stations_of({a, b}, config, &of_none);
  REQUIRE(stations.size() == 4);
  CHECK(stations[3].points == 0);
  CHECK(stations[3].subject == "number 77");
  CHECK_FALSE(stations[3].counts());
  CHECK(of_none.points == 1);
  CHECK(of_none.subject == "number 9 of " + a);
  CHECK(stations[0].points == 1);
  CHECK(stations[1].points == 2);
  CHECK(stations[2].name == "bee");
  CHECK(stations[2].points == 2);
}

TEST_CASE("a file of stations none of which has a point is an error that names what the scan has") {
  const ScratchFolder folder;
  const std::string scan = folder.write("a.xyz", "x y z scan\n1 0 0 1\n2 0 0 2\n");
  OutputConfig config;
  config.stations = folder.write("stations.txt", "five 0 0 5 5\nsix 0 0 6 6\n");
  CHECK_THROWS_WITH(stations_of({scan}, config),
                    config.stations +
                        ": no station has a point: five has those of number 5, and the scan has "
                        "points of number 1 of " +
                        scan);
}

TEST_CASE("a station far off its points is not certain, however far it is") {
  const ScratchFolder folder;
  std::string text;
  for (int i = 0; i < 1000; ++i)
    text += std::to_string(i % 10) + " " + std::to_string(i / 10 % 10) + " " + std::to_string(i / 100) + "\n";
  const std::string scan = folder.write("cube.xyz", text);
  OutputConfig config;
  for (const std::string place : {"300 5 5", "5 -300 5", "5 5 1e9"}) {
    config.stations = folder.write("stations.txt", "far " + place + "\n");
    CHECK(stations_of({scan}, config).at(0).certainty == 0);
  }
  config.stations = folder.write("stations.txt", "near 4.5 4.5 30\n");
  CHECK(stations_of({scan}, config).at(0).certainty > 0);
  const std::string pcd = folder.write("far.pcd", test::ascii_pcd("1 2 3\n", "1e200 0 0"));
  CHECK(stations_of({pcd}).at(0).certainty == 0);
}

TEST_CASE("many rays of one range are without return, and a surface seen straight on is none") {
  const ScratchFolder folder;
  const auto one_range = [&](double phantom) {
    std::string rows;
    for (int i = -60; i <= 60; ++i) {
      for (int j = -60; j <= 60; ++j) {
        const Eigen::Vector3d ray = Eigen::Vector3d(60, i, j) / 60;
        const bool is_window = phantom > 0 && std::max(std::abs(i), std::abs(j)) < 20;
        const Eigen::Vector3d at = is_window ? Eigen::Vector3d(phantom * ray.normalized()) : 3 * ray;
        rows += fmt::format("{:.4f} {:.4f} {:.4f}\n", at.x(), at.y(), at.z());
      }
    }
    OutputConfig config;
    config.stations = folder.write("stations.txt", "0 0 0\n");
    return stations_of({folder.write("wall.xyz", rows)}, config).at(0).one_range;
  };
  CHECK(one_range(0) == 0);
  for (const double phantom : {0.6, 0.9, 80.0}) CHECK(one_range(phantom) == Approx(phantom).epsilon(2e-3));
}

TEST_CASE("a narrow view counts where the scan itself states its station", "[io]") {
  const ScratchFolder folder;
  std::string rows;
  for (int i = 0; i < 400; ++i) rows += std::to_string(i % 20) + " " + std::to_string(i / 20) + " 0\n";
  const std::string pcd = folder.write("range.pcd", test::ascii_pcd(rows, "10 10 300"));
  CHECK(stations_of({pcd}).at(0).certainty == 1);
  OutputConfig config;
  config.stations = folder.write("stations.txt", "listed 10 10 300\n");
  CHECK(stations_of({pcd}, config).at(0).certainty == 0);
}

TEST_CASE("without ranges, stations have all but certainty and step, and take no disk space") {
  const ScratchFolder folder, empty;
  OutputConfig config;
  config.stations = folder.write("stations.txt", "one 0 0 5\n");
  const ScanFiles scan({folder.write("a.xyz", "1 2 3\n4 5 6\n")}, {});
  const auto views = watch_stations(scan, config, empty / "none", Ranges::kNone);
  views->complete(TaskArena(2));
  const auto stations = views->summaries();
  REQUIRE(stations.size() == 1);
  CHECK(stations[0].points == 2);
  CHECK(stations[0].farthest == Approx(std::sqrt(42)));
  CHECK(stations[0].lowest == Approx(-2 / 3.0));
  CHECK(std::isnan(stations[0].certainty));
  CHECK(views->disk_bytes() == RangeImage::kBytes);
}

TEST_CASE("stations that a scan names and a file does not count no more") {
  const ScratchFolder folder;
  OutputConfig config;
  config.stations = folder.write("stations.txt", "stated 0 0 5\n");
  const auto stations =
      stations_of({ScanInput(folder.write("b.xyz", "1 2 3\n"), parse_pose("10 20 30 0 0 0 1"))}, config);
  REQUIRE(stations.size() == 1);
  CHECK(stations[0].name == "stated");
}

// ---- What is up

constexpr double kStep = 0.2;

struct Drawn {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;

  // A rectangle with edges along two axes, from its least corner.
  Drawn& add(const Eigen::Vector3d& corner, const Eigen::Vector3d& sizes) {
    int flat = 0;
    sizes.minCoeff(&flat);
    const int u = (flat + 1) % 3, v = (flat + 2) % 3;
    for (double a = 0; a < sizes[u]; a += kStep) {
      for (double b = 0; b < sizes[v]; b += kStep) {
        Eigen::Vector3d at = corner;
        at[u] += a;
        at[v] += b;
        points.push_back(at);
        normals.push_back(Eigen::Vector3f::Unit(flat));
      }
    }
    return *this;
  }

  std::optional<Upward> turned(const Eigen::Quaterniond& turn) const {
    Drawn other = *this;
    for (Eigen::Vector3d& point : other.points) point = turn * point + Eigen::Vector3d(5e5, 5e6, 100);
    for (Eigen::Vector3f& normal : other.normals) normal = turn.cast<float>() * normal;
    return other_upward(other.points, other.normals, static_cast<double>(points.size()) * kStep * kStep);
  }
  // Turns the scene so that its z becomes this direction.
  std::optional<Upward> with_up(const Eigen::Vector3d& up) const {
    return turned(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up));
  }
};

// A level ground with walls on it.
Drawn yard() {
  Drawn scene;
  scene.add({0, 0, 0}, {24, 24, 0});
  for (int i = 0; i < 6; ++i) {
    scene.add({4.0 * i, 3 + std::fmod(7.3 * i, 16), 0}, {3, 0, 2});
    scene.add({2 + std::fmod(5.1 * i, 18), 4.0 * i, 0}, {0, 3, 2});
  }
  return scene;
}

Drawn room() {
  Drawn scene;
  for (const double side : {0.0, 1.0})
    scene.add({0, 0, 2.6 * side}, {8, 6, 0})
        .add({0, 6 * side, 0}, {8, 0, 2.6})
        .add({8 * side, 0, 0}, {0, 6, 2.6});
  return scene;
}

TEST_CASE("what is up is found in all three axes and both senses, and z upwards is no finding") {
  const Drawn scene = yard();
  CHECK_FALSE(scene.with_up({0, 0, 1}));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sense : {1.0, -1.0}) {
      if (axis == 2 && sense > 0) continue;
      INFO(axis << " " << sense);
      const auto found = scene.with_up(sense * Eigen::Vector3d::Unit(axis));
      REQUIRE(found);
      CHECK(found->axis == axis);
      CHECK(found->is_known);
      CHECK(found->is_down == (sense < 0));
      CHECK(found->level[static_cast<std::size_t>(axis)] > 14'000);
    }
  }
}

TEST_CASE("below a ceiling, things hide the floor: what has fewer level ends is down") {
  Drawn hall;
  hall.add({0, 0, 6}, {24, 24, 0}).add({0, 0, 0}, {24, 18, 0});
  for (int i = 0; i < 15; ++i) hall.add({0, 18 + 2 * kStep * i, 0.5}, {24, 0, 2});  // shelves from the side
  CHECK_FALSE(hall.with_up({0, 0, 1}));
  const auto found = hall.with_up({0, 0, -1});
  REQUIRE(found);
  CHECK((found->axis == 2 && found->is_down));
}

TEST_CASE("a room on its side shows which axis is vertical, but not which end is up") {
  CHECK_FALSE(room().with_up({0, 0, 1}));
  CHECK_FALSE(room().with_up({0, 0, -1}));  // it looks alike
  const auto found = room().with_up({0, 1, 0});
  REQUIRE(found);
  CHECK(found->axis == 1);
  CHECK_FALSE(found->is_known);
}

TEST_CASE("walls with more points than the ground, and a corridor of walls alone, are no finding") {
  CHECK_FALSE(Drawn().add({0, 0, 0}, {30, 0, 20}).add({0, 0, 0}, {30, 4, 0}).with_up({0, 0, 1}));
  CHECK_FALSE(Drawn().add({0, 0, 0}, {30, 0, 6}).add({0, 4, 0}, {30, 0, 6}).with_up({0, 0, 1}));
  CHECK_FALSE(Drawn().with_up({0, 0, 1}));
}

// ---- Where to stand next

// Points 0.05 apart on a rectangle from `corner` along x or y, and up.
void add_wall(const Eigen::Vector3d& corner, const Eigen::Vector3d& along, double length, double height,
              std::vector<Eigen::Vector3d>& points) {
  for (double s = 0; s <= length; s += 0.05)
    for (double z = 0; z <= height; z += 0.05)
      points.push_back(corner + s * along + Eigen::Vector3d(0, 0, z));
}

InnerSample on_floor(double x, double y, double area) {
  return {{x, y, 0}, {0, 0, 1}, area};
}

TEST_CASE("a ray is blocked by points between its ends, and not by those at its ends") {
  std::vector<Eigen::Vector3d> points;
  add_wall({1, 0, 0}, {0, 1, 0}, 2, 2, points);
  const Obstacles obstacles(points, 0.1);
  CHECK(obstacles.block({0, 1, 1}, {2, 1, 1}));
  CHECK(obstacles.block({0.1, 0.4, 1.7}, {1.9, 1.6, 0.2}));
  CHECK_FALSE(obstacles.block({0, 1, 3}, {2, 1, 3}));     // over it
  CHECK_FALSE(obstacles.block({0, 1, 1}, {1, 1, 1}));     // to it
  CHECK_FALSE(obstacles.block({1.02, 1, 1}, {3, 1, 1}));  // from it
  const Eigen::Vector3d far(5e5, 5.4e6, 300);             // voxels there have numbers beyond 2^31
  std::vector<Eigen::Vector3d> moved;
  for (const Eigen::Vector3d& point : points) moved.push_back(point + far);
  const Obstacles fine(moved, 0.001);
  CHECK(fine.block(moved.front() - Eigen::Vector3d(1, 0, 0), moved.front() + Eigen::Vector3d(1, 0, 0)));
  CHECK_FALSE(fine.block(far + Eigen::Vector3d(0, 1, 3), far + Eigen::Vector3d(2, 1, 3)));
  CHECK(obstacles.touch({Eigen::Vector3d(0.9, 0.9, 0.9), Eigen::Vector3d(1.1, 1.1, 1.1)}));
  CHECK_FALSE(obstacles.touch({Eigen::Vector3d(0.2, 0.9, 0.9), Eigen::Vector3d(0.8, 1.1, 1.1)}));
}

TEST_CASE("next stations are chosen by what each adds, within range and angle") {
  std::vector<Eigen::Vector3d> points;
  add_wall({5, 0, 0}, {0, 1, 0}, 10, 3, points);
  const Obstacles obstacles(points, 0.1);
  const std::vector<InnerSample> hidden = {on_floor(2, 5, 3), on_floor(8, 5, 2), on_floor(8, 2, 2),
                                           on_floor(2, 9, 0.01)};
  const std::vector<Eigen::Vector3d> eyes = {{1, 5, 1.6}, {9, 5, 1.6}, {3, 5, 1.6}};
  const SightLimits limits{.range = 6, .least_cosine = 0.1};
  const auto chosen = choose_stations(hidden, eyes, obstacles, limits, 5);
  REQUIRE(chosen.size() == 2);  // the third sees what the first does
  CHECK(chosen[0].index == 1);
  CHECK(chosen[0].eye == eyes[1]);
  CHECK(chosen[0].area == Approx(4));
  CHECK(chosen[1].index == 0);
  CHECK(chosen[1].eye == eyes[0]);
  CHECK(chosen[1].area == Approx(3.01));
  CHECK(choose_stations(hidden, eyes, obstacles, limits, 1).size() == 1);
  CHECK(choose_stations(hidden, eyes, obstacles, {.range = 1, .least_cosine = 0}, 5).empty());
  CHECK(choose_stations(hidden, eyes, obstacles, {.range = 6, .least_cosine = 0.9}, 5).empty());
  CHECK(choose_stations({}, eyes, obstacles, limits, 5).empty());
}

TEST_CASE("two next stations see at least 63 % of what the best two would") {
  const Obstacles nothing({}, 0.1);
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Random random(seed);
    std::vector<InnerSample> hidden;
    for (int i = 0; i < 200; ++i)
      hidden.push_back(on_floor(random.uniform(0, 20), random.uniform(0, 20), random.uniform()));
    std::vector<Eigen::Vector3d> eyes;
    for (int i = 0; i < 30; ++i) eyes.emplace_back(random.uniform(0, 20), random.uniform(0, 20), 1.6);
    const SightLimits limits{.range = 6, .least_cosine = 0.1};
    double best = 0;
    for (const Eigen::Vector3d& a : eyes) {
      for (const Eigen::Vector3d& b : eyes) {
        double area = 0;
        for (const NextStation& station : choose_stations(hidden, std::vector{a, b}, nothing, limits, 2))
          area += station.area;
        best = std::max(best, area);
      }
    }
    const auto chosen = choose_stations(hidden, eyes, nothing, limits, 2);
    REQUIRE(chosen.size() == 2);
    CHECK(chosen[0].area >= chosen[1].area);
    CHECK(chosen[0].area + chosen[1].area >= 0.632 * best);
    CHECK(chosen[0].area + chosen[1].area <= best * (1 + 1e-12));
  }
}

TEST_CASE("eyes stand over the floor, neither on tables nor in walls") {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;
  const auto add_level = [&](double x0, double y0, double size, double z) {
    for (double x = x0; x < x0 + size; x += 0.05)
      for (double y = y0; y < y0 + size; y += 0.05) points.emplace_back(x, y, z);
    normals.resize(points.size(), {0, 0, -1});
  };
  add_level(0, 0, 6, 0);
  add_level(2, 2, 1.5, 0.75);
  add_level(0, 0, 6, 2.7);
  add_wall({4, 0, 0}, {0, 1, 0}, 6, 2.7, points);
  normals.resize(points.size(), {1, 0, 0});
  const Obstacles obstacles(points, 0.1);
  const auto eyes =
      eyes_over_floor(points, normals, obstacles, {.height = 1.6, .grid = 0.5, .clearance = 0.3});
  CHECK(eyes.size() > 60);
  for (const Eigen::Vector3d& eye : eyes) {
    CHECK(eye.z() == Approx(1.6));
    CHECK(std::abs(eye.x() - 4) > 0.25);
    CHECK((eye.head<2>() - Eigen::Vector2d(2.75, 2.75)).cwiseAbs().maxCoeff() > 0.6);
  }
}

}  // namespace
}  // namespace lacuna::io
