// SPDX-License-Identifier: Apache-2.0
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
namespace {

// Turned by a quarter about z, and moved.
const std::string kPose = "10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n";
const std::string kStill = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

// A beginning is complete where a block ends.
std::vector<WholeFile> whole_files() {
  return {{.name = "grey.ptx",
           .bytes = "2\n1\n" + kPose + "1 2 3 0.5\n0 0 0 0.25\n1\n1\n" + kStill + "4 5 6 1\n",
           .complete_from = 0},
          {.name = "colours.ptx",
           .bytes = "1\n2\n" + kStill + "1 2 3 0.5 255 0 300\n4 5 6 0.5 1 2 3\n0\n5\n" + kPose,
           .complete_from = 0}};
}

TEST_CASE("rays of PTX have the pose of their block, and those without a return no coordinates", "[io]") {
  const ScratchFolder folder;
  const std::string ptx =
      "2\n1\n" + kPose + "1 2 3 0.5\n0 0 0 0.25\n" + "1\r\n2\r\n" + kStill + "4 5 6 1\n\n7 8 9 0\n";
  const Table table = read_table(folder.write("a.xyz", ptx));
  CHECK(table.names == std::vector<std::string>{"x", "y", "z", "intensity", "scan"});
  REQUIRE(table.rows.size() == 4);
  CHECK(table.rows[0] == std::vector<double>{8, 21, 33, 0.5, 0});
  CHECK(std::isnan(table.rows[1][0]));
  CHECK(table.rows[1][3] == 0.25);
  CHECK(table.rows[2] == std::vector<double>{4, 5, 6, 1, 1});
  CHECK(table.rows[3] == std::vector<double>{7, 8, 9, 0, 1});
}

TEST_CASE("the first ray of PTX says whether there are colours, also behind an empty grid", "[io]") {
  const ScratchFolder folder;
  const std::string coloured = "1\n2\n" + kStill + "1 2 3 4 255 0 300\n4 5 6 0.5 1 2 3\n";
  const std::string bare = "1\n1\n" + kStill + "1 2 3 4\n", nothing = "0\n5\n" + kStill;
  const auto rows = [&](const std::string& text) { return read_table(folder.write("a.ptx", text), 1).rows; };
  CHECK(rows(nothing).empty());
  CHECK(rows(nothing + bare) == Rows{{1, 2, 3, 4, 1}});
  CHECK(rows(nothing + coloured) == Rows{{1, 2, 3, 4, 255, 0, 255, 1}, {4, 5, 6, 0.5, 1, 2, 3, 1}});
  CHECK(rows(coloured + bare).back() == std::vector<double>{1, 2, 3, 4, 0, 0, 0, 1});
  CHECK(rows(bare + coloured) == Rows{{1, 2, 3, 4, 0}, {1, 2, 3, 4, 1}, {4, 5, 6, 0.5, 1}});
}

TEST_CASE("what is wrong in PTX is said with its line", "[io]") {
  check_refused("a.ptx", {{"2\n1\n" + kStill + "1 2 3 4\n", "line 12: the file ends here, too early"},
                          {"1\n1\n" + kStill + "1 2 3\n", "line 11: a ray needs"},
                          {"1\n1\n0 0 0\n1 0\n" + kStill, "line 4: a pose needs 3 numbers"},
                          {"1\n1\n" + kStill + "1 2 3 4\nhello\n", "line 12: 'hello' is no number"},
                          {"1\n1\n" + kStill + "1 2 3 4 5 nan 7\n", "line 11: a colour is not a number"},
                          {"9999999999999\n9999999999999\n" + kStill, "a grid of"}});
}

// A block of three rays, which lie one apart from `first` on along x.
std::string block(const std::string& place, const std::string& matrix, double first = 1) {
  std::string text = "3\n1\n" + place + "\n1 0 0\n0 1 0\n0 0 1\n" + matrix + "\n";
  for (int i = 0; i < 3; ++i) text += std::to_string(first + i) + " 2 3 0.5\n";
  return text;
}

const std::string kUnturned = "1 0 0 0\n0 1 0 0\n0 0 1 0\n";

TEST_CASE("a matrix of PTX is a pose, as in a list of files", "[io]") {
  const std::string rays = "the matrix by columns, ", odd = rays + "the matrix of a pose does not turn";
  check_refused(
      "a.ptx", {{block("0 0 0", "1 0 0 7\n0 1 0 8\n0 0 1 9\n0 0 0 1"),
                 "line 10: of " + rays + "the last row of a pose is not 0 0 0 1"},
                {block("0 0 0", "0 0 0 0\n0 0 0 0\n0 0 0 0\n7 8 9 1"), odd},
                {block("0 0 0", "1 0 0 0\n0 1 0 0\n0 0 -1 0\n7 8 9 1"), odd},
                {block("0 0 0", "2 0 0 0\n0 1 0 0\n0 0 1 0\n7 8 9 1"), odd},
                {block("7 8 9", kUnturned + "7 8 9 1") + block("0 0 0", "1 0 0 7\n0 1 0 8\n0 0 1 9\n0 0 0 1"),
                 "line 23: "}});
  const ScratchFolder folder;
  const std::string zeros = "0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n";
  const std::string empty = "0\n0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + zeros;
  CHECK(read_table(folder.write("a.ptx", empty + block("0 0 0", "2 0 0 0\n0 2 0 0\n0 0 2 0\n7 8 9 1")))
            .rows[0] == std::vector<double>{9, 12, 15, 0.5, 1});
}

TEST_CASE("PTX: a scanner position that is not the place of the matrix is found", "[io]") {
  const ScratchFolder folder;
  const auto other_places = [&](const std::string& text) {
    return findings_of(folder.write("a.ptx", text)).other_places;
  };
  CHECK(other_places(block("7 8 9", kUnturned + "7 8 9.5 1")) == 0);  // rounded, to half a step
  CHECK(other_places(block("7 8 9", kUnturned + "7 8 11 1")) == 1);
  CHECK(other_places(block("7 8 9", kUnturned + "7 8 9 1") + block("0 0 0", kUnturned + "7 8 9 1")) == 1);
}

TEST_CASE("PTX: a broken file gives one error or whole rays", "[io]") {
  check_broken_files(whole_files(), 7);
}

TEST_CASE("PTX: many broken files give one error or whole rays", "[io][.slow]") {
  check_many_broken_files(whole_files(), 7);
}

}  // namespace
}  // namespace lacuna::test
