// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/station.hpp"

#include "io/explain/stations/station_views.hpp"
#include "tests/io/io_support.hpp"

namespace lacuna::io {
namespace {

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

}  // namespace

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

TEST_CASE("a pause divides a path: there is no place in it, and each part has its own axes") {
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

TEST_CASE("a scanner measures in directions of many rays, not of a few") {
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
