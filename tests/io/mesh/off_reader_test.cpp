// SPDX-License-Identifier: Apache-2.0
#include "tests/io/broken_files.hpp"

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace io;

namespace {

using Rows = std::vector<std::vector<double>>;
using Names = std::vector<std::string>;

const std::string kMesh =
    "# by hand\nCNOFF\n3 2 0 # counts\n\n1 2 3 0 0 1 9 8 7 1 # first\n#\n4 5 6 0 1 0 6 5 4 1\n"
    "7 8 9 1 0 0 3 2 1 0\n3 0 1 2\n3 2 1 0 255 0 0\n";

std::vector<WholeFile> whole_files() {
  const std::string plain = "OFF 3 2 0\n1 2 3\n4 5 6.5\n7 8 -9e2\n3 0 1 2\n4 0 1 2 0\n";
  return {{.name = "colours.off", .bytes = kMesh, .complete_from = kMesh.rfind(" 255")},  // of the last face
          {.name = "plain.off", .bytes = plain, .complete_from = plain.size() - 1}};
}

}  // namespace

TEST_CASE("OFF: vertices are rows, and faces are passed over", "[io]") {
  const ScratchFolder folder;
  for (const std::string content :
       {"OFF\n2 1 0\n1 2 3\n4 5 6\n3 0 1 0\n", "OFF 2 1 0\n1 2 3\n4 5 6\n3 0 1 0", "OFF2 0\n1 2 3\n4 5 6",
        "OFF # cut by hand\r\n# two\r\n2 1\r\n\r\n1 2 3\r\n#\r\n4 5 6 # last\r\n3 0 1 0 0.5 0.5 0.5\r\n "
        "\r\n"}) {
    INFO(content);
    const auto file = folder.write("a.xyz", content);
    const Table table = read_table(file, 1);
    CHECK(table.names == Names{"x", "y", "z"});
    CHECK(table.rows == Rows{{1, 2, 3}, {4, 5, 6}});
    CHECK(open_scan(file, {})->format() == "OFF");
    CHECK(open_scan(file, {})->expected_rows() == 2u);
  }
  CHECK(read_table(folder.write("a.off", "OFF\n0 0 0\n")).rows.empty());
  CHECK(read_table(folder.write("a.off", "COFF\n0 0 0\n")).rows.empty());
}

TEST_CASE("OFF: normals and colours are kept", "[io]") {
  const ScratchFolder folder;
  const Table both = read_table(folder.write("a.off", kMesh));
  CHECK(both.names == Names{"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha"});
  CHECK(both.rows ==
        Rows{{1, 2, 3, 0, 0, 1, 9, 8, 7, 1}, {4, 5, 6, 0, 1, 0, 6, 5, 4, 1}, {7, 8, 9, 1, 0, 0, 3, 2, 1, 0}});
  CHECK(open_scan(folder.write("a.off", kMesh), {})->format() == "CNOFF");
  const Table normals = read_table(folder.write("a.off", "NOFF\n1 0 0\n1 2 3 0 1 0\n"));
  CHECK(normals.names == Names{"x", "y", "z", "nx", "ny", "nz"});
  CHECK(normals.rows == Rows{{1, 2, 3, 0, 1, 0}});
  const Table colours = read_table(folder.write("a.off", "COFF\n2 0 0\n1 2 3 0.5 0 1\n1 2 3 255 0 1\n"));
  CHECK(colours.names == Names{"x", "y", "z", "red", "green", "blue"});
  CHECK(colours.rows == Rows{{1, 2, 3, 0.5, 0, 1}, {1, 2, 3, 255, 0, 1}});
}

TEST_CASE("OFF: binary files and other kinds of vertices are refused by name", "[io]") {
  const ScratchFolder folder;
  CHECK_THAT(read_error(folder.write("a.off", std::string("OFF BINARY\n\0\0\0\2", 15))),
             Catch::Contains("a.off: line 1: binary OFF cannot be read"));
  for (const std::string kind : {"ST", "4", "n", "STCN"}) {
    CHECK_THAT(
        read_error(folder.write("a.off", kind + "OFF\n1 0 0\n1 2 3 4 5\n")),
        Catch::Contains("line 1: vertices of kind '" + kind + "OFF' cannot be read; allowed are OFF, COFF"));
  }
}

TEST_CASE("OFF: points as text are not taken for it", "[io]") {
  const ScratchFolder folder;
  for (const std::string content : {"x y z OFF\n1 2 3 4\n", "1 2 3\n4 5 6\n", "OFF x y z\n1 2 3 4\n"}) {
    CHECK(open_scan(folder.write("a.off", content), {})->format() == "text");
  }
}

TEST_CASE("OFF: what does not hold is an error that names its line", "[io]") {
  const ScratchFolder folder;
  const std::pair<std::string, std::string> cases[] = {
      {"OFF\n", "a.off: line 1: the file ends here; the numbers"},
      {"OFF\n2\n1 2 3\n1 2 3\n", "line 2: fewer values than needed; the numbers"},
      {"OFF\n1 0 0 0\n1 2 3\n", "line 2: more values"},
      {"OFF\n-1 0 0\n", "line 2: '-1' is not a whole number"},
      {"OFF\n1 0 0\n1 2 \n\n", "line 3: fewer values"},
      {"OFF\n1 0 0\n1 2 3 4\n", "line 3: more values"},
      {"OFF\n2 0 0\n1 2 3\n1 two 3\n", "line 4: 'two' is not a number"},
      {"COFF\n2 0 0\n1 2 3 4 5 6\n1 2 3 4 5 6 7\n", "line 4: more values"},
      {"OFF\n2 0 0\n1 2 3.00000000\n", "line 3: the file ends here with fewer than the 2 vertices"},
      {"OFF\n1 2 0\n1 2 3\n3 0 0 0\n", "line 4: the file ends here with fewer than the 1 faces"},
      {"OFF\n1 1 0\n1 2 3\n0.5 2 3\n", "line 4: '0.5' is not a whole number"},
      {"OFF\n1 1 0\n1 2 3\n3 0 0\n", "line 4: fewer values than needed; a face"},
      {"OFF\n1 0 0\n1 2 3\n1 2 3\n", "line 4: more data after the last face"},
      {"OFF\n1000000000000000000 0 0\n1 2 3\n",
       "byte 34: the file ends here, too early for the 1000000000000000000"},
      {"OFF\n1 18446744073709551615 0\n1 2 3\n",
       "too early for the 1 vertices and 18446744073709551615 faces"},
  };
  for (const auto& [content, expected] : cases) {
    INFO(content);
    CHECK_THAT(read_error(folder.write("a.off", content)), Catch::Contains(expected));
  }
}

TEST_CASE("OFF: a broken file gives one error or all its rows", "[io]") {
  check_broken_files(whole_files(), 6);
}

TEST_CASE("OFF: many broken files give one error or all their rows", "[io][.slow]") {
  check_many_broken_files(whole_files(), 6);
}

}  // namespace lacuna::test
