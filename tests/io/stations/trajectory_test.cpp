// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/trajectory.hpp"

#include "tests/io/io_support.hpp"

namespace lacuna::io {
namespace {

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

}  // namespace
}  // namespace lacuna::io
