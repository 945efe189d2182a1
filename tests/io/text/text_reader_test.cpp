// SPDX-License-Identifier: Apache-2.0
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
  CHECK_THAT(error(ids), Catch::Contains("line 1: no header line, and the first column counts the rows, in "
                                         "'0,0.5,0.25,1.75' first; --columns"));
  CHECK_THAT(error(rows(50, [](int i) { return std::to_string(i + 1) + " 3 4 5 6"; })),
             Catch::Contains("counts the rows"));
  CHECK_THAT(error(rows(50, [&](int i) { return number(i + 1001) + "," + places(i); })),
             Catch::Contains("counts the rows"));
  const auto file = folder.write("a.csv", ids);
  CHECK(read_table(file, 1000, {.columns = "id x y z"}).rows.size() == 50);
  CHECK(read_table(folder.write("a.csv", "id,x,y,z\n" + ids)).rows.size() == 50);
}

TEST_CASE("columns of the field are x, y and z by their names, also in comments", "[io]") {
  const ScratchFolder folder;
  const auto names = [&](const std::string& text) { return read_table(folder.write("a.txt", text)).names; };
  CHECK(names("# id Easting Northing Elevation\n7 1 2 3\n") == Names{"id", "x", "y", "z"});
  CHECK(names("Northing (m),Easting (m),Height (m)\n1,2,3\n") == Names{"y", "x", "z"});
  CHECK(names("# X_m Y_m Z_m\n1 2 3\n") == Names{"x", "y", "z"});
  CHECK(names("# a list\n# ID, X, Y, Z, ERROR, TRACK[] as (IMAGE, POINT)\n# Number of points: 2\n"
              "1 2 3 4 0.5 6 7\n2 3 4 5 0.5\n") == Names{"ID", "x", "y", "z", "ERROR"});
  CHECK_THAT(read_error(folder.write("a.txt", "# ID LONGITUDE_LOW LATITUDE_LOW ELEVATION_LOW\n1 2 3 4\n")),
             Catch::Contains("no columns named x, y and z"));
  CHECK_THAT(read_error(folder.write("a.txt", "# id x y z\n1 2 3 4 5\n")),
             Catch::Contains("the row has 5 values, and the comment before it names 4 columns"));
}

TEST_CASE("whole numbers before three columns with decimals are not taken for x", "[io]") {
  const ScratchFolder folder;
  const auto error = [&](const std::string& text) { return read_error(folder.write("a.xyz", text)); };
  const auto number = [](int i) { return std::to_string(i); };
  const auto place = [&](int i) { return number(i % 7) + ".5 " + number(i % 5) + ".25 1.75"; };
  CHECK_THAT(error(rows(60, [&](int i) { return number(i / 9) + " " + number(i % 9) + " " + place(i); })),
             Catch::Contains("the first 2 columns have whole numbers alone"));
  CHECK_THAT(error(rows(60, [&](int i) { return number(99 * i % 61) + " " + place(i); })),
             Catch::Contains("the first column has whole numbers alone"));
  CHECK_THAT(error(rows(60, [&](int i) { return "42." + number(i + 10) + " " + place(i); })),
             Catch::Contains("rises from row to row"));
}

TEST_CASE("longitude and latitude in text are known by their names", "[io]") {
  const ScratchFolder folder;
  const auto is_geographic = [&](const std::string& text, const std::string& columns = "") {
    return open_scan(folder.write("a.txt", text), {.columns = columns})->is_geographic();
  };
  CHECK(is_geographic("# lat lon alt\n48 11 500\n"));
  CHECK(is_geographic("Longitude,Latitude,Height\n48,11,500\n"));
  CHECK(is_geographic("1 2 3\n", "lat lon alt"));
  CHECK(is_geographic("id,LAT_A,LON_A,H\n1,2,3,4\n", "x=LON_A y=LAT_A z=H") == false);
}

TEST_CASE("columns of words are not read, quotes and empty cells are", "[io]") {
  const ScratchFolder folder;
  const Table words =
      read_table(folder.write("a.csv", "Point;X;Y;Z;Code\nP0;1;2;3;TOPO\nP1;4;5;6;\"a;b\"\n"));
  CHECK(words.names == Names{"x", "y", "z"});
  CHECK(words.rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read_table(folder.write("a.csv", "\"X\",\"Y\",\"Z\"\n\"1\",\"2.5\",\"-3\"\n")).rows ==
        Rows{{1, 2.5, -3}});
  CHECK(read_table(folder.write("a.csv", "\"1,5\",\"2,5\",\"3,0\"\n")).rows == Rows{{1.5, 2.5, 3}});
  const Table empty = read_table(folder.write("a.csv", "x,y,z,i\n1,2,3,\n1,2,3,4\n1,,3,NA\n"));
  CHECK(std::isnan(empty.rows.at(0)[3]));
  CHECK(std::isnan(empty.rows.at(2)[1]));
  CHECK(std::isnan(empty.rows.at(2)[3]));
  CHECK(read_table(folder.write("a.csv", "1,2,3,4\n"), 9, {.columns = "_ x y z"}).rows == Rows{{2, 3, 4}});
  CHECK(read_table(folder.write("a.csv", "9 1 2 3 4 5\n9 1 2 3\n"), 9, {.columns = "_ x y z ..."}).rows ==
        Rows{{1, 2, 3}, {1, 2, 3}});
}

TEST_CASE("lines before the header are passed over", "[io]") {
  const ScratchFolder folder;
  const std::string before = "Project: Test\nDate: 2020\nUnits: m\n";
  CHECK(read_table(folder.write("a.txt", before + "X Y Z\n1 2 3\n4 5 6\n")).rows ==
        Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read_table(folder.write("a.txt", "X,Y,Z\nm,m,m\n1,2,3\n")).rows == Rows{{1, 2, 3}});
  CHECK_THAT(read_error(folder.write("a.txt", before + "1 2 3\n")),
             Catch::Contains("line 1: 'Project: Test' is neither a header line"));
  CHECK(read_table(folder.write("a.txt", before + "1 2 3\n"), 9, {.columns = "x y z"}).rows ==
        Rows{{1, 2, 3}});
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
  const std::string text = "Nord,Ost,Hoehe,I\n1,2,3,4\n";
  const Table table = read_table(folder.write("a.csv", text), 10, {.columns = "x=Ost y=Nord z=Hoehe"});
  CHECK(table.names == std::vector<std::string>{"y", "x", "z", "I"});
  CHECK(table.rows == Rows{{1, 2, 3, 4}});
  const auto error = [&](const std::string& columns) {
    return read_error(folder.write("a.csv", text), {.columns = columns});
  };
  CHECK(error("").find("no columns named x, y and z, but 'Nord', 'Ost', 'Hoehe', 'I'; --columns "
                       "x=...,y=...,z=...") != std::string::npos);
  CHECK(error("x=East y=Nord z=Hoehe").find("no column for 'x=East'; the columns are 'Nord', 'Ost'") !=
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
      {"EDITION 0.7\n1 2 3\n", "line 1: 'EDITION 0.7' is neither a header"},
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
