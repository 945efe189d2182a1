// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/station.hpp"

#include "io/explain/stations/directions.hpp"
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

}  // namespace lacuna::io
