// SPDX-License-Identifier: Apache-2.0
#include "io/formats.hpp"
#include "tests/io/broken_files.hpp"

#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace io;

namespace {

using Rows = std::vector<std::vector<double>>;
using Names = std::vector<std::string>;

// A beginning is complete where a row ends, and a counted block.
std::vector<WholeFile> whole_files() {
  const std::pair<const char*, const char*> files[] = {
      {"header.csv", "# c\nx;y;z;w\n1;2;3;4\n// d\n-5e1;nan;7.25;8\n"},
      {"quotes.csv", "\"Intensity\",\"X\",\"Y\",\"Z\"\r\n9,1,2,3\r\n10,-4,5.5,6e-1\r\n"},
      {"plain.xyz", "// by hand\n1 2 3 0.5\n\n4.25\t-5 6 7\n 7 8 9 inf\n"},
      {"blocks.pts", "2\n1 2 3 40\n4 5 6 41\n1 \r\n7 8 9 42\n"},
      {"commas.txt", "1,5 2,25 3\n4,5 -5 6,0\n1.0D+02 2.5d-1 -1.#IND\n"}};
  std::vector<WholeFile> whole;
  for (const auto& [name, bytes] : files) whole.push_back({.name = name, .bytes = bytes, .complete_from = 0});
  return whole;
}

}  // namespace

TEST_CASE("blanks, commas and semicolons divide the values of a row", "[io]") {
  const ScratchFolder folder;
  for (const std::string content :
       {"1 2 3\n4 5 6\n", "  1\t2  3 \r\n4 5 6", "1,2,3\n4,5,6\n", "1, 2 ,3,\n 4,5,6\n", "1;2;3\r\n4; 5;6\n",
        "\xef\xbb\xbf"
        "1 2 3\n\n4 5 6\n\n"}) {
    INFO(content);
    const Table table = read_table(folder.write("a.xyz", content));
    CHECK(table.names == Names{"x", "y", "z"});
    CHECK(table.rows == Rows{{1, 2, 3}, {4, 5, 6}});
  }
}

TEST_CASE("columns are named by the options, else by a header line, else by place", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.txt", "1 2 3 4 5\n")).names ==
        Names{"x", "y", "z", "column_4", "column_5"});
  const auto file = folder.write("a.csv", "Intensity,X,Y,Z,NX,Scan Angle\n9,1,2,3,4,5\n");
  CHECK(read_table(file).names == Names{"Intensity", "x", "y", "z", "nx", "Scan_Angle"});
  CHECK(read_table(file).rows == Rows{{9, 1, 2, 3, 4, 5}});
  CHECK(read_table(file, 10, {.columns = "z y x a b c"}).names == Names{"z", "y", "x", "a", "b", "c"});
  CHECK(read_table(file, 10, {.columns = "z y x a b c"}).rows.size() == 1);
  CHECK(read_table(folder.write("a.csv", "\"x\",\"y\",\"z\"\n1,2,3\n")).names == Names{"x", "y", "z"});
}

std::string rows(int count, const std::function<std::string(int)>& row) {
  std::string text;
  for (int i = 0; i < count; ++i) text += row(i) + "\n";
  return text;
}

TEST_CASE("a first column that counts the rows is not taken for x", "[io]") {
  const ScratchFolder folder;
  const auto error = [&](const std::string& text) { return read_error(folder.write("a.csv", text)); };
  const auto number = [](int i) { return std::to_string(i); };
  const auto places = [&](int i) { return number(i * i) + ".5," + number(7 * i % 5) + ".25,1.75"; };
  const std::string ids = rows(50, [&](int i) { return number(i) + "," + places(i); });
  CHECK_THAT(
      error(ids),
      Catch::Contains(
          "line 1: no header line, and in '0,0.5,0.25,1.75' the first column counts the rows; --columns"));
  CHECK_THAT(error(rows(50, [](int i) { return std::to_string(i + 1) + " 3 4 5 6"; })),
             Catch::Contains("counts the rows"));
  CHECK_THAT(error(rows(50, [&](int i) { return number(i + 1001) + "," + places(i); })),
             Catch::Contains("counts the rows"));
  const auto file = folder.write("a.csv", ids);
  CHECK(read_table(file, 1000, {.columns = "id x y z"}).rows.size() == 50);
  CHECK(read_table(folder.write("a.csv", "id,x,y,z\n" + ids)).rows.size() == 50);
}

TEST_CASE("columns without names that are probably not x, y and z are asked about", "[io]") {
  const ScratchFolder folder;
  const auto error = [&](const std::function<std::string(int)>& row) {
    return read_error(folder.write("a.xyz", rows(50, row)));
  };
  const auto number = [](int i) { return std::to_string(i); };
  const auto place = [&](int i) { return number(i * i % 17) + ".25 " + number(i % 7) + ".5 1.75"; };
  CHECK_THAT(
      error([&](int i) { return number(7 * i * i) + " " + place(i); }),
      Catch::Contains("the first column has whole numbers alone") && Catch::Contains("--columns id,x,y,z"));
  CHECK_THAT(error([&](int i) { return number(i / 8) + " " + number(i % 8) + " " + place(i); }),
             Catch::Contains("the first two columns have whole numbers alone"));
  CHECK_THAT(error([&](int i) { return number(i % 17) + ".25 " + number(i % 17) + ".25 1"; }),
             Catch::Contains("column 2 repeats column 1"));
  const auto file = folder.write(
      "a.xyz", rows(50, [&](int i) { return number(i / 8) + " " + number(i % 8) + " " + place(i); }));
  CHECK(read_table(file, 1000, {.columns = "row column x y z"}).rows[0] ==
        std::vector<double>{0, 0, 0.25, 0.5, 1.75});
}

TEST_CASE("names of the field are x, y and z, in a header or in a comment before the rows", "[io]") {
  const ScratchFolder folder;
  const auto names = [&](const std::string& text) { return read_table(folder.write("a.txt", text)).names; };
  CHECK(names("Nr;East;North;Height\n7;1;2;3\n") == Names{"Nr", "x", "y", "z"});
  CHECK(names("# id Easting Northing Elevation\n# made today\n7 1 2 3\n") == Names{"id", "x", "y", "z"});
  CHECK(names("N [m],E [m],H [m]\n2,1,3\n") == Names{"y", "x", "z"});
  CHECK(names("X_m Y_m Z_m I\n1 2 3 4\n") == Names{"x", "y", "z", "I"});
  CHECK(names("x y z height\n1 2 3 4\n") == Names{"x", "y", "z", "height"});
  // Which of the two is meant?
  CHECK_THAT(read_error(folder.write("a.txt", "East North Height Elevation\n1 2 3 4\n")),
             Catch::Contains("no columns named x, y and z"));
}

TEST_CASE("longitude and latitude are known by their names, or by their numbers", "[io]") {
  const ScratchFolder folder;
  const auto are_degrees = [&](const std::string& text) {
    return open_scan(folder.write("a.txt", text), {})->is_geographic();
  };
  CHECK(are_degrees("Latitude,Longitude,Altitude\n48.1,11.2,500\n"));
  CHECK(are_degrees("# id LONGITUDE_LOW LATITUDE_LOW ELEVATION_LOW LONGITUDE_HIGH\n7 11.2 48.1 500 11.3\n"));
  CHECK(read_table(folder.write("a.txt", "lat lon h\n48.1 11.2 500\n")).names == Names{"y", "x", "z"});
  const auto number = [](int i) { return std::to_string(i); };
  CHECK(are_degrees(rows(50, [&](int i) { return "11.0000" + number(i + 10) + " 48.0001 512.5"; })));
  CHECK(are_degrees(
      rows(50, [&](int i) { return "11.0000" + number(i + 10) + " 48.0001 " + number(i) + ".5"; })));
  // A depth image, and a scan in metres with heights above the sea.
  CHECK(!are_degrees(rows(50, [&](int i) { return "0." + number(i + 10) + " 0.25 1." + number(i); })));
  CHECK(!are_degrees(rows(50, [&](int i) { return number(i) + ".5 7.25 512.5"; })));
}

TEST_CASE("text, quotes, empty cells and lines before the header do not hide the points", "[io]") {
  const ScratchFolder folder;
  const auto table = [&](const std::string& text) { return read_table(folder.write("a.csv", text)); };
  for (const std::string text :
       {"PointID;X;Y;Z;Code\nP0;1;2;3;TOPO\nP1;4;5;6;\n",
        "\"i\",\"X\",\"Y\",\"Z\"\n\"-\",\"1\",\"2\",\"3\"\n-,4,5,6\n",
        "Project: Test\nUnits: m\ni X Y Z\n- 1 2 3\n- 4 5 6\n", "i,x,y,z,a,b\n-,1,2,3\n-,4,5,6,7\n"}) {
    INFO(text);
    const Table read = table(text);
    REQUIRE(read.rows.size() == 2);
    for (int row = 0; row < 2; ++row) {
      CHECK(std::isnan(read.rows[row][0]));
      for (int axis = 0; axis < 3; ++axis) CHECK(read.rows[row][axis + 1] == 3 * row + axis + 1);
    }
  }
  CHECK(std::isnan(table("1,2,3\n4,,6\n").rows[1][1]));
  CHECK_THAT(read_error(folder.write("a.csv", "x,y,z\n1,2,3\n4,five,6\n")),
             Catch::Contains("line 3: 'five' is not a number"));
}

TEST_CASE("a list at the end of a row is passed over, as COLMAP writes it", "[io]") {
  const ScratchFolder folder;
  const std::string text =
      "# 3D point list with one line of data per point:\n"
      "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n"
      "# Number of points: 2, mean track length: 3\n"
      "9 1 2 3 10 20 30 0.5 1 2 3 4\n7 4 5 6 10 20 30 0.5 1 2 3 4 5 6\n";
  const Table read = read_table(folder.write("points3D.txt", text));
  CHECK(read.names == Names{"POINT3D_ID", "x", "y", "z", "R", "G", "B", "ERROR"});
  CHECK(read.rows == Rows{{9, 1, 2, 3, 10, 20, 30, 0.5}, {7, 4, 5, 6, 10, 20, 30, 0.5}});
}

TEST_CASE("x on a grid is x", "[io]") {
  const ScratchFolder folder;
  const auto error = [&](const std::string& text) { return read_error(folder.write("a.xyz", text)); };
  const auto number = [](int i) { return std::to_string(i); };
  // A depth image without and with a fourth value, a row of a height model, a short profile.
  CHECK(error(rows(60, [&](int i) { return number(i) + " 0 1.5"; })).empty());
  CHECK(error(rows(60, [&](int i) { return number(i % 20) + " " + number(i / 20) + " 1.5 7"; })).empty());
  CHECK(error(rows(60, [&](int i) { return number(500000 + i) + " 5400000 312.5 1"; })).empty());
  CHECK(error(rows(9, [&](int i) { return number(i) + " 0 1.5 7"; })).empty());
  CHECK(error(rows(60, [&](int i) { return number(2 * i) + " 0 1.5 7"; })).empty());
}

TEST_CASE("text of more than 10,000 columns is refused", "[io]") {
  const ScratchFolder folder;
  std::string line = "1";
  for (int i = 1; i < 10'000; ++i) line += " 1";
  CHECK(read_table(folder.write("a.xyz", line + "\n")).names.size() == 10'000);
  CHECK_THAT(read_error(folder.write("a.xyz", line + " 1\n")),
             Catch::Contains("line 1: more than the 10,000 columns that are read"));
}

TEST_CASE("a header line may be divided by something else than the rows", "[io]") {
  const ScratchFolder folder;
  const std::string files[] = {"\"X\",\"Y\",\"Z\"\n1 2 3\n4 5 6\n", "x y z\n1,2,3\n4,5,6\n",
                               "x;y;z\n\n1\t2\t3\n4\t5\t6\n", "x,y,z\n1;2;3\n4;5;6\n"};
  for (const std::string& text : files) {
    const Table table = read_table(folder.write("a.csv", text));
    CHECK(table.names == std::vector<std::string>{"x", "y", "z"});
    CHECK(table.rows == Rows{{1, 2, 3}, {4, 5, 6}});
  }
  CHECK(read_table(folder.write("a.csv", "x;y;z\n1,5 2 3\n")).rows == Rows{{1.5, 2, 3}});
  CHECK_THAT(read_error(folder.write("a.csv", "x,y,z\n1 2 3\n4,5,6\n")), Catch::Contains("line 3"));
  CHECK_THAT(read_error(folder.write("a.csv", "x,y,z\n1 2 3 4\n")), Catch::Contains("line 2"));
}

TEST_CASE("comments are passed over, but may name the columns of the first row", "[io]") {
  const ScratchFolder folder;
  const Table plain =
      read_table(folder.write("a.txt", "# by hand\n// and more\n1 2 3 4\n#5 6 7 8\n  // 9\n5 6 7 8\n"));
  CHECK(plain.names == Names{"x", "y", "z", "column_4"});
  CHECK(plain.rows == Rows{{1, 2, 3, 4}, {5, 6, 7, 8}});
  CHECK(read_table(folder.write("a.txt", "//X Y Z Nx Ny Nz\n1 2 3 4 5 6\n")).names ==
        Names{"x", "y", "z", "nx", "ny", "nz"});
  CHECK(read_table(folder.write("a.txt", "# four words of prose\n1 2 3 4\n")).names ==
        Names{"x", "y", "z", "column_4"});
}

TEST_CASE("a bare count on the first line is what the rows must come to", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.pts", "2\n1 2 3\n4 5 6\n")).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read_table(folder.write("a.pts", "0\n")).rows.empty());
  CHECK(read_table(folder.write("a.pts", "1\n1 2 3 40\n")).names == Names{"x", "y", "z", "intensity"});
  CHECK(read_table(folder.write("a.pts", "1\n1 2 3 9 8 7\n")).names ==
        Names{"x", "y", "z", "red", "green", "blue"});
  CHECK(read_table(folder.write("a.pts", "1\n1 2 3 -40 9 8 7\n")).names ==
        Names{"x", "y", "z", "intensity", "red", "green", "blue"});
  CHECK(read_table(folder.write("a.xyz", "1 2 3 -40 9 8 7\n")).names.back() == "column_7");
  CHECK(read_error(folder.write("a.pts", "2\n")).find("line 1: ") != std::string::npos);
  CHECK(read_error(folder.write("a.pts", "3\n1 2 3\n4 5 6\n"))
            .find("line 3: the file ends here with fewer rows than the 3 that") != std::string::npos);
  CHECK(read_error(folder.write("a.pts", "1\n1 2 3\n4 5 6\n7 8 9\n"))
            .find("line 3: more rows than the 1 that") != std::string::npos);
}

TEST_CASE("several counted blocks are one scan", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.pts", "2\n1 2 3\n4 5 6\n1 \r\n7 8 9\n")).rows ==
        Rows{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  CHECK(read_error(folder.write("a.pts", "1\n1 2 3\n2\n4 5 6\n"))
            .find("line 4: the file ends here with fewer rows than the 2") != std::string::npos);
}

TEST_CASE("decimal commas, exponents of Fortran and what is not a number for Microsoft are numbers", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.txt", "1,5 2,25 3\n4,5 -5 6,0\n")).rows ==
        Rows{{1.5, 2.25, 3}, {4.5, -5, 6}});
  CHECK(read_table(folder.write("a.txt", "x;y;z\n1,5;2,25;3\n")).rows == Rows{{1.5, 2.25, 3}});
  const Table odd = read_table(folder.write("a.txt", "1.0D+02 2.5d-1 -1.#IND\n1.#QNAN 1.#INF -1.#INF00\n"));
  CHECK(odd.rows[0][0] == 100);
  CHECK(odd.rows[0][1] == 0.25);
  CHECK(std::isnan(odd.rows[0][2]));
  CHECK(std::isnan(odd.rows[1][0]));
  CHECK(odd.rows[1][1] == std::numeric_limits<double>::infinity());
  CHECK(odd.rows[1][2] == -std::numeric_limits<double>::infinity());
  for (const char* wrong : {"1.#X 2 3\n", "1 2 3,4,5\n", "1 2 1D2D3\n"})
    CHECK(read_error(folder.write("a.txt", wrong)) != "");
}

TEST_CASE("columns of a header may be given other names", "[io]") {
  const ScratchFolder folder;
  const std::string text = "Along,Across,Up,I\n1,2,3,4\n";
  const Table table = read_table(folder.write("a.csv", text), 10, {.columns = "x=Across y=Along z=Up"});
  CHECK(table.names == std::vector<std::string>{"y", "x", "z", "I"});
  CHECK(table.rows == Rows{{1, 2, 3, 4}});
  const auto error = [&](const std::string& columns) {
    return read_error(folder.write("a.csv", text), {.columns = columns});
  };
  CHECK(error("").find("no columns named x, y and z, but 'Along', 'Across', 'Up', 'I'; --columns "
                       "x=...,y=...,z=...") != std::string::npos);
  CHECK(error("x=East y=Along z=Up").find("no column for 'x=East'; the columns are 'Along', 'Across'") !=
        std::string::npos);
}

TEST_CASE("a header line alone is an empty scan, comments alone are none", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.csv", "x,y,z\n")).rows.empty());
  CHECK(read_error(folder.write("a.csv", "# nothing\n\n")) != "");
  CHECK(read_error(folder.write("a.csv", "\n")) != "");
}

TEST_CASE("values that are not finite or out of range are read as doubles", "[io]") {
  const ScratchFolder folder;
  const Rows rows = read_table(folder.write("a.txt", "nan inf -inf\nNaN 1e999 1e-999\n0.1 +3 -0\n")).rows;
  CHECK(std::isnan(rows.at(0)[0]));
  CHECK(std::isinf(rows[0][1]));
  CHECK(rows[0][2] < 0);
  CHECK(std::isnan(rows.at(1)[0]));
  CHECK(std::isinf(rows[1][1]));
  CHECK(rows[1][2] == 0);
  CHECK(rows.at(2)[0] == 0.1);
}

TEST_CASE("a row that does not fit is an error that names its line", "[io]") {
  const ScratchFolder folder;
  const std::pair<std::string, std::string> cases[] = {
      {"1 2 3\n\n4 5\n", "line 3: fewer values than the 3 columns"},
      {"1 2 3\n4 5 6 7\n", "line 2: more values than the 3 columns"},
      {"1 2 3\n4 5 six\n", "line 2: 'six' is not a number"},
      {"1 2 three\n", "line 1: 'three' is not a number"},
      {"1,2,3\n4,5,6,,\n", "line 2: more values"},
      {"1,5;2,5;x\n", "line 1: 'x' is not a number"},
      {"1 2\n", "line 1: 2 values"},
      {"a b c\n1 2 3\n", "line 1: no columns named x, y and z"},
      {"x y z x\n1 2 3 4\n", "line 1: a second column 'x'"},
      {"x y z gr\xc3\xb6\xc3\x9f\xc2\x9b\xff gr\xc3\xb6\xc3\x9f\xc2\x9b\xff\n",
       "line 1: a second column 'gr\xc3\xb6\xc3\x9f"
       "?"
       "?'"},
      {"x y z\n1 2 3 4\n", "line 2: more values"},
      {"1 2 3\r4 5 6\r", "line 1: a carriage return within the line"},
      {"# x y z\r1 2 3\r\n", "line 1: a carriage return within the line"},
      {"1 2 3\n4 5 \x01\x02\n",
       "line 2: '?"
       "?' is not a number"},
  };
  for (const auto& [content, expected] : cases) {
    INFO(content);
    const std::string error = read_error(folder.write("a.txt", content));
    INFO(error);
    CHECK(error.find("a.txt: " + expected) != std::string::npos);
  }
  CHECK(read_error(folder.write("a.txt", "1 2 3\n"), {.columns = "x y z w"}).find("line 1: fewer") !=
        std::string::npos);
  CHECK(read_error(folder.write("a.txt", "1 2 3\n"), {.columns = "x y"}).find("no columns") !=
        std::string::npos);
}

TEST_CASE("lines of text stay whole across buffers and batches", "[io]") {
  const ScratchFolder folder;
  constexpr int kRows = 120'000;
  std::string text;
  for (int i = 0; i < kRows; ++i) text += std::to_string(i) + ", 0.5, -" + std::to_string(i) + "\r\n";
  const auto file = folder.write("a.csv", text);
  for (const std::size_t max_rows : {1u, 65536u, 1'000'000u}) {
    const Rows rows = read_table(file, max_rows).rows;
    REQUIRE(rows.size() == kRows);
    bool all = true;
    for (int i = 0; i < kRows; ++i) all = all && rows[i] == std::vector<double>{1.0 * i, 0.5, -1.0 * i};
    CHECK(all);
  }
}

TEST_CASE("text that is broken gives one error or whole rows", "[io]") {
  check_broken_files(whole_files(), 8);
}

TEST_CASE("many broken files of text give one error or whole rows", "[io][.slow]") {
  check_many_broken_files(whole_files(), 8);
}

}  // namespace lacuna::test
