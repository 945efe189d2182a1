// SPDX-License-Identifier: Apache-2.0
// Moving scanners: files of places, their path, and what they have seen along it.
#include "io/explain/stations/path_view.hpp"

#include "io/explain/stations/find_causes.hpp"
#include "io/explain/stations/station.hpp"
#include "io/explain/stations/trajectory.hpp"
#include "tests/io/io_support.hpp"

namespace lacuna::io {

// ---- Lists of places

TEST_CASE("a list of places has x y z on each line, and maybe a name before them") {
  const ScratchFolder folder;
  const auto places = read_places(folder.write("places.txt",
                                               "name;x;y;z\n"
                                               "# a comment\n"
                                               "\n"
                                               "door; 1; -2.5; 3e2\n"
                                               "4 5\t6\r\n"
                                               "17,7,8,9\n"
                                               "gate;1,5;-2,25;3\n"
                                               "1,5 2,5 3,5\n"));
  REQUIRE(places.size() == 5);
  CHECK(places[0].name == "door");
  CHECK(places[0].position == Eigen::Vector3d(1, -2.5, 300));
  CHECK(places[1].name.empty());
  CHECK(places[1].position == Eigen::Vector3d(4, 5, 6));
  CHECK(places[2].name == "17");
  CHECK(places[2].position == Eigen::Vector3d(7, 8, 9));
  CHECK(places[3].name == "gate");
  CHECK(places[3].position == Eigen::Vector3d(1.5, -2.25, 3));  // decimal commas
  CHECK(places[4].position == Eigen::Vector3d(1.5, 2.5, 3.5));
}

TEST_CASE("an error in a list of places names the file, the line and what is needed") {
  const ScratchFolder folder;
  const std::string needed = "x y z are needed, or a name and x y z";
  test::check_reasons({{"", "places.txt: names no place"},
                       {"", needed},
                       {"# 1 2 3\nx y z\n", "names no place"},
                       {"1 2\n", "line 1: "},
                       {"1 2 3\na 4 5 6 7\n", "line 2: "},
                       {"1 2 3\n\n4 5 six\n", "line 3: 'six' is not a number"},
                       {"1 2 3\n\n4 5 six\n", needed},
                       {"1 2 3\nx y z\n", "line 2: 'x' is not a number"},
                       {"door 1 inf 3\n", "line 1: 'inf' is not a number"},
                       {"1 2 3\n1 1e30 3\n", "line 2: '1e30' is not from -1e+12 to 1e+12"},
                       {"1 2 nan\n", "line 1: 'nan' is not a number"}},
                      [&](const std::string& text) {
                        return test::error_of([&] { read_places(folder.write("places.txt", text)); });
                      });
  CHECK_THROWS_WITH(read_places(folder / "none.txt"), Contains("none.txt: cannot be opened"));
}

namespace {

// ---- Paths

std::optional<Trajectory> read(const std::string& text, std::uint64_t memory = 1 << 20) {
  const ScratchFolder folder;
  return read_trajectory(folder.write("path.txt", text), memory);
}

TEST_CASE("a trajectory has its columns by the names of its header, in any order of columns and lines") {
  const auto path = read(
      "# a comment\n"
      "x,y,roll,gps_time,z\n"
      "3,0,9,12,1\n"
      "0,0,9,10,1\n"
      "3,4,9,13,1\n");
  REQUIRE(path);
  CHECK(path->first_time() == 10);
  CHECK(path->last_time() == 13);
  CHECK(path->length() == 7);
  CHECK(path->length_at(11) == 1.5);
  CHECK(path->length_at(13) == 7.0);
  CHECK(path->place_at(5) == Eigen::Vector3d(3, 2, 1));
  CHECK_FALSE(path->length_at(9.9));
  CHECK_FALSE(path->length_at(13.1));
}

TEST_CASE("the columns of a trajectory have the names that headers of scans have") {
  for (const std::string header : {
           "# timestamp tx ty tz",
           "#timestamp x y z",
           "# columns: time x y z",
           "timestamp,x,y,z",
           "Time (s);Easting (m);Northing (m);Height (m)",
           "GPSTime X_m Y_m Elev",
           "t\tE\tN\th",
           "GPS Time [s],Easting,Northing,Altitude",
           "\"GpsTime\",\"East\",\"North\",\"H\"",
           "Project: a drive\nGPSTime Easting Northing Height\n(sec) (m) (m) (m)",
           "\xef\xbb\xbftime x y z",
       }) {
    INFO(header);
    const bool has_blanks = header.find_first_of(",;") == header.npos;
    const auto path = read(header + (has_blanks ? "\n10 1 2 3\n12 1 4 3\n" : "\r\n10,1,2,3\r\n12,1,4,3\r\n"));
    REQUIRE(path);
    CHECK(path->length_at(11) == 1.0);
    CHECK(path->place_at(1) == Eigen::Vector3d(1, 3, 3));
  }
  const auto tum = read("# timestamp tx ty tz qx qy qz qw\n1.0 1 2 3 0 0 0 1\n# pause\n2,5 1 2 4 0 0 0 1\n");
  REQUIRE(tum);
  CHECK(tum->last_time() == 2.5);
  CHECK(tum->length() == 1);
}

TEST_CASE("a file without a column of times is no trajectory, but a list of stations") {
  CHECK_FALSE(read("name x y z\nnorth 1 2 3\n"));
  CHECK_FALSE(read("10 1 2 3\n"));
  CHECK_FALSE(read("# time of the survey: noon\nnorth 1 2 3\n"));
}

TEST_CASE("an error in a trajectory names the line or the column") {
  std::vector<test::Wrong> cases = {
      {"time x y\n1 2 3\n", "no columns named x, y and z, but 'time', 'x', 'y'; a trajectory has"},
      {"time,lat,lon,alt\n1,2,3,4\n", "has longitude and latitude: 'time', 'lat', 'lon', 'alt'"},
      {"time x y z\n1 2 3 4\n2 2 three 4\n", "line 3: 'three' is not a number"},
      {"time x y z\n1 2 3 4\n2 2 3\n", "line 3: has 3 columns; the header names 4"},
      {"time x y z\n1 2 3 inf\n", "is not a number"},
      {"time x y z\n1e300 2 3 4\n", "line 2: '1e300' is not from -1e+20 to 1e+20"},
      {"time x y z\n1 2 3 4\n1 5 6 7\n", "fewer than two times"},
      {"time x y z\n", "path.txt: "},
      {"time x y z\n", "fewer than two times"}};
  for (const std::string far : {"1e308", "-1e200", "1e30", "1e13"})
    cases.push_back(
        {"time x y z\n1 2 3 4\n2 2 " + far + " 4\n", "line 3: '" + far + "' is not from -1e+12 to 1e+12"});
  test::check_reasons(cases, [](const std::string& text) { return test::error_of([&] { read(text); }); });
}

// A drive along x at speed 10, with a row each tenth of a second. Rows of `off` lie at `place` instead.
std::string drive(const std::vector<int>& off, const std::string& place, int standing = 0) {
  std::string text = "time x y z\n";
  for (int i = 0; i < 100; ++i) {
    const bool is_off = std::ranges::find(off, i) != off.end();
    text += std::to_string(1000 + 0.1 * i) + " " +
            (is_off ? place : std::to_string(5e5 + std::max(0, i - standing)) + " 5400000 20") + "\n";
  }
  return text;
}

TEST_CASE("rows far off a path are left out and counted, wherever they are") {
  std::vector<int> tenth;
  for (int i = 5; i < 100; i += 10) tenth.push_back(i);
  for (const std::vector<int>& off : {std::vector<int>{50}, {0}, {99}, {0, 1, 2}, {40, 41, 42, 43}, tenth}) {
    for (const std::string place : {"0 0 0", "500040 5405000 20", "500040 5400000 0.5e6"}) {
      INFO(off.size() << " from " << off.front() << " at " << place);
      const auto path = read(drive(off, place));
      REQUIRE(path);
      CHECK(path->left_out().rows == off.size());
      CHECK(path->left_out().time == Approx(1000 + 0.1 * off.front()));
      CHECK(path->length() < 99.1);
    }
  }
}

TEST_CASE("a drive after a long stop, and a jump within a path, leave out no row") {
  CHECK(read(drive({}, ""))->left_out().rows == 0);
  CHECK(read(drive({}, "", 90))->length() == Approx(9));
  CHECK(read(drive({}, "", 90))->left_out().rows == 0);
  std::vector<int> half;
  for (int i = 0; i < 50; ++i) half.push_back(i);
  CHECK(read(drive(half, "0 0 0"))->left_out().rows == 0);  // which half is off?
}

TEST_CASE("a binary file of stations or of a path, such as SBET, is an error that says so") {
  CHECK_THROWS_WITH(read(std::string(136, '\0')), Contains("path.txt: is binary, as SBET files are"));
}

TEST_CASE("a trajectory of more lines than memory has space for is refused") {
  const std::string text = "time x y z\n0 0 0 0\n1 1 0 0\n2 2 0 0\n";
  CHECK(read(text, 300).has_value());
  CHECK_THROWS_WITH(read(text, 299), Contains("more than the 2 lines that the memory limit has space for"));
}

TEST_CASE("a pause divides a path: there is no place in it, and axes are those of each part") {
  const auto path = read(
      "time x y z\n"
      "0 0 0 0\n1 1 0 0\n2 2 0 0\n3 3 0 0\n"
      "100 3 50 0\n101 2 50 0\n102 1 50 0\n103 0 50 0\n");
  REQUIRE(path);
  CHECK_FALSE(path->length_at(50));
  CHECK_FALSE(path->length_at(3.5));
  CHECK(path->length_at(3) == 3.0);
  CHECK(path->length_at(100) == 53.0);
  const auto forward = [&](double length) { return Eigen::Vector3d(path->axes_at(length, 2).row(0)); };
  CHECK(forward(3).isApprox(Eigen::Vector3d(1, 0, 0)));
  CHECK(forward(53).isApprox(Eigen::Vector3d(-1, 0, 0)));
  const Eigen::Matrix3d axes = path->axes_at(55, 1);
  CHECK(axes.row(1).isApprox(Eigen::RowVector3d(0, -1, 0)));
  CHECK(axes.row(2).isApprox(Eigen::RowVector3d(0, 0, 1)));
}

TEST_CASE("a scanner measures in directions that have many rays, not in those of a few") {
  SweptDirections swept;
  for (int i = 0; i < 1000; ++i) swept.add({0, 1, i % 10 * 0.1});
  swept.add({1, 0, 0});
  swept.finish();
  CHECK(swept.contains({0, 5, 2.5}));
  CHECK_FALSE(swept.contains({1, 0, 0}));
  CHECK_FALSE(swept.contains({0, -1, 0}));
}

// ---- What was seen along a path

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

}  // namespace
}  // namespace lacuna::io
