// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/station.hpp"
#include "tests/io/io_support.hpp"

namespace lacuna::io {

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

}  // namespace lacuna::io
