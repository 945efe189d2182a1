// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/station_views.hpp"

#include "io/explain/stations/find_causes.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/test.hpp"

#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

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

}  // namespace

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

namespace {

// A scanner drives from 0 to 20 along x, 2 over a floor, and turns around its path. A wall stands at y = 5,
// with a window, and a screen before a part of it.
double range_of(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  double nearest = 0;
  const auto hit = [&](int axis, double at, const std::function<bool(const Eigen::Vector3d&)>& is_there) {
    const double range = (at - eye[axis]) / direction[axis];
    if (!(range > 0) || (nearest > 0 && nearest < range) || !is_there(eye + range * direction)) return;
    nearest = range;
  };
  hit(2, 0, [](const auto& p) { return std::fabs(p.y()) < 20; });
  hit(1, 5, [](const auto& p) {
    const bool is_window = p.x() > 4 && p.x() < 6 && p.z() > 1 && p.z() < 3;
    return p.z() > 0 && p.z() < 6 && !is_window;
  });
  hit(1, 9, [](const auto& p) { return p.z() > 0 && p.z() < 4; });  // behind the wall
  hit(1, 2.5, [](const auto& p) { return p.x() > 12 && p.x() < 15 && p.z() > 0 && p.z() < 1.5; });
  return nearest;
}

// Times are from `start` on, in these steps where there are steps.
void measure(PathView& view, bool is_reversed = false, double start = 100, double step = 0) {
  constexpr int kProfiles = 400, kRays = 720;
  for (int i = 0; i < kProfiles; ++i) {
    const int profile = is_reversed ? kProfiles - 1 - i : i;
    const Eigen::Vector3d eye(20.0 * profile / kProfiles, 0, 2);
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2 * std::numbers::pi * (ray + 0.5) / kRays;
      const Eigen::Vector3d direction(0, std::cos(angle), std::sin(angle));
      const double range = range_of(eye, direction);
      const double since = 2.0 * profile / kProfiles;
      const double time = start + (step > 0 ? std::floor(since / step) * step : since);
      if (range > 0 && range < 15) view.add(time, eye + range * direction, true);
    }
  }
  view.complete();
}

class Drive {
 public:
  explicit Drive(double start = 100)
      : view({{start, start + 2}, {{0, 0, 2}, {20, 0, 2}}}, "path.txt", 1, folder_.path(), 1 << 20) {}

  // A square of edge 1 in a plane with this normal.
  LoopCause cause_at(const Eigen::Vector3d& middle, int normal) const {
    std::vector<Eigen::Vector3d> loop(4, middle);
    const int u = (normal + 1) % 3, v = (normal + 2) % 3;
    loop[0][u] -= 0.5, loop[1][v] -= 0.5, loop[2][u] += 0.5, loop[3][v] += 0.5;
    return cause_of(inside_places(loop), {}, &view, 0.1);
  }

 private:
  ScratchFolder folder_;

 public:
  PathView view;
};

}  // namespace

TEST_CASE("a moving scanner says why a place has no points") {
  Drive drive;
  measure(drive.view);
  CHECK(drive.view.certainty() == 1);
  CHECK(drive.cause_at({5, 5, 2}, 1).share(Cause::kOpening) > 0.95);  // the window
  const LoopCause hidden = drive.cause_at({13.5, 5, 0.6}, 1);         // behind the screen
  CHECK(hidden.share(Cause::kHidden) > 0.95);
  CHECK(hidden.hidden_by.y() == Approx(2.5).margin(0.1));
  CHECK(hidden.hidden_from_place.x() == Approx(13.5).margin(0.3));
  CHECK(hidden.hidden_from == 0);
  CHECK(drive.cause_at({21.5, 5, 2}, 1).share(Cause::kOutOfView) == 1);  // past the end of the path
  CHECK_FALSE(drive.cause_at({9, 5, 4}, 1).main());                      // has points
}

TEST_CASE("what a moving scanner says depends neither on the order of points nor on last digits of times") {
  Drive forward, backward(1.7e9);
  measure(forward.view);
  measure(backward.view, true, 1.7e9);
  for (const double x : {3.9, 4.1, 5.0, 5.8, 12.2, 13.5, 14.9})
    CHECK(forward.cause_at({x, 5, 1.2}, 1).shares == backward.cause_at({x, 5, 1.2}, 1).shares);
  CHECK(forward.view.farthest() == Approx(backward.view.farthest()));
}

TEST_CASE("times in steps in which a scanner moves are coarse, and with one time for all it does not count") {
  Drive coarse, one;
  measure(coarse.view, false, 100, 0.05);
  measure(one.view, false, 101, 3);
  CHECK(coarse.view.summary().coarse_step == Approx(0.05));
  CHECK(std::isinf(one.view.summary().coarse_step));
  CHECK(one.view.certainty() == 0);
}

TEST_CASE("points without a time of the path make a moving scanner uncertain, and then it gives no cause") {
  Drive drive;
  for (int i = 0; i < 20'000; ++i) drive.view.add(99, {1, 2, 3}, true);
  measure(drive.view);
  CHECK(drive.view.certainty() < StationView::kLeastCertain);
  CHECK(drive.view.summary().untimed == 20'000);
  CHECK_FALSE(drive.cause_at({5, 5, 2}, 1).main());
}

TEST_CASE("a path beside the places of the scanner is not certain, near or far") {
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0, 30, 0), {0, 300, 0}, {300, 0, 0}, {0, 0, 3e6}}) {
    INFO(off);
    const ScratchFolder folder;
    PathView view({{100, 102}, {Eigen::Vector3d(0, 0, 2) + off, Eigen::Vector3d(20, 0, 2) + off}}, "path.txt",
                  1, folder.path(), 1 << 20);
    measure(view);
    CHECK(view.certainty() < StationView::kLeastCertain);
    CHECK(view.summary().certainty == view.certainty());
  }
}

// 7 / (7 * 0.02) is less than 50 in floating point, 7 / 0.02 is 350.
TEST_CASE("a point at the very end of a path is measured from a section of it") {
  const ScratchFolder folder;
  PathView view({{100, 102}, {{0, 0, 0}, {7, 0, 0}}}, "path.txt", 1, folder.path(), 1 << 20);
  const Eigen::Vector3d point(7, 14.5, 0);
  view.add(102, point, true);
  view.complete();
  CHECK(view.sections_near({point, point}, 20) == std::vector<std::uint32_t>{50});
}

TEST_CASE("a path at other times than all points is an error that names both") {
  Drive drive;
  drive.view.add(7, {1, 2, 3}, true);
  CHECK_THROWS_WITH(drive.view.complete(),
                    Contains("path.txt") && Contains("7 to 7") && Contains("100 to 102"));
}

}  // namespace lacuna::io
