// SPDX-License-Identifier: Apache-2.0
// Points as text: of any columns, and PTX.
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
namespace {

// ---- Columns

Table read(const std::string& text, const std::string& columns = "") {
  const ScratchFolder folder;
  return read_table(folder.write("a.txt", text), 10, {.columns = columns});
}
Names names(const std::string& text, const std::string& columns = "") {
  return read(text, columns).names;
}
std::string error(const std::string& text, const std::string& columns = "") {
  const ScratchFolder folder;
  return read_error(folder.write("a.txt", text), {.columns = columns});
}

std::string rows(int count, const std::function<std::string(int)>& row) {
  std::string text;
  for (int i = 0; i < count; ++i) text += row(i) + "\n";
  return text;
}
std::string number(int i) {
  return std::to_string(i);
}

const Names kThree = {"x", "y", "z"};

TEST_CASE("blanks, commas and semicolons divide the values of a row, the header's too", "[io]") {
  for (const std::string text :
       {"1 2 3\n4 5 6\n", "  1\t2  3 \r\n4 5 6", "1,2,3\n4,5,6\n", "1, 2 ,3,\n 4,5,6\n", "1;2;3\r\n4; 5;6\n",
        "\xef\xbb\xbf"
        "1 2 3\n\n4 5 6\n\n",
        "\"X\",\"Y\",\"Z\"\n1 2 3\n4 5 6\n", "x y z\n1,2,3\n4,5,6\n", "x;y;z\n\n1\t2\t3\n4\t5\t6\n",
        "x,y,z\n1;2;3\n4;5;6\n"}) {
    INFO(text);
    const Table table = read(text);
    CHECK(table.names == kThree);
    CHECK(table.rows == Rows{{1, 2, 3}, {4, 5, 6}});
  }
  CHECK(read("x;y;z\n1,5 2 3\n").rows == Rows{{1.5, 2, 3}});
  check_refused("a.csv", {{"x,y,z\n1 2 3\n4,5,6\n", "line 3"}, {"x,y,z\n1 2 3 4\n", "line 2"}});
}

TEST_CASE("columns are named by the options, else by a header line, else by place", "[io]") {
  CHECK(names("1 2 3 4 5\n") == Names{"x", "y", "z", "column_4", "column_5"});
  const std::string text = "Intensity,X,Y,Z,NX,Scan Angle\n9,1,2,3,4,5\n";
  CHECK(names(text) == Names{"Intensity", "x", "y", "z", "nx", "Scan_Angle"});
  CHECK(read(text).rows == Rows{{9, 1, 2, 3, 4, 5}});
  CHECK(names(text, "z y x a b c") == Names{"z", "y", "x", "a", "b", "c"});
  CHECK(read(text, "z y x a b c").rows.size() == 1);
}

TEST_CASE("a first column that counts the rows, and whole numbers before decimals, are not taken for x",
          "[io]") {
  const auto places = [&](int i) { return number(i * i) + ".5," + number(7 * i % 5) + ".25,1.75"; };
  const auto place = [&](int i) { return number(i % 7) + ".5 " + number(i % 5) + ".25 1.75"; };
  const std::string ids = rows(50, [&](int i) { return number(i) + "," + places(i); });
  check_refused("a.csv",
                {{ids, "line 1: no header line, and the first column counts the rows"},
                 {rows(50, [](int i) { return number(i + 1) + " 3 4 5 6"; }), "counts the rows"},
                 {rows(50, [&](int i) { return number(i + 1001) + "," + places(i); }), "counts the rows"},
                 {rows(60, [&](int i) { return number(i / 9) + " " + number(i % 9) + " " + place(i); }),
                  "the first 2 columns have whole numbers alone"},
                 {rows(60, [&](int i) { return number(99 * i % 61) + " " + place(i); }),
                  "the first column has whole numbers alone"},
                 {rows(60, [&](int i) { return "42." + number(i + 10) + " " + place(i); }),
                  "never falls from row to row"},
                 {rows(60, [&](int i) { return "42." + number(i / 6) + " " + place(i); }),
                  "never falls from row to row"},
                 {rows(60, [&](int i) { return "0." + number(37 * i % 60 + 10) + " 5" + place(i) + " 4.5"; }),
                  "the first column is from 0 to 1"},
                 {rows(60,
                       [&](int i) {
                         const std::string share = "0." + number(37 * i % 60 + 10) + " ";
                         return share + "0.5 0.25 5" + place(i);
                       }),
                  "the first three columns are from 0 to 1"}});
  CHECK(read(ids, "id x y z").rows.size() == 50);
  CHECK(read("id,x,y,z\n" + ids).rows.size() == 50);
}

TEST_CASE("more than 20 columns without names may be a matrix of heights, and need names", "[io]") {
  std::string row = "1 2 3";
  for (int column = 3; column < 20; ++column) row += " 4";
  CHECK(read(row + "\n").names.size() == 20);
  check_refused("a.txt", {{row + " 4\n", "line 1: 21 columns without names, as a matrix of heights has"}});
  CHECK(read(row + " 4\n", "x y z ...").rows == Rows{{1, 2, 3}});
}

TEST_CASE("commas and blanks that mean two things are an error of one line", "[io]") {
  const std::string commas = "500,317,5400000,100,12,018\n500,634,5400000,200,12,018\n";
  const std::string decimals = "line 1: commas divide the values, and may begin their decimals, too, in '";
  for (const std::string& text :
       {commas, std::string("0,05, -0,40, 12,02\n"), std::string("7,0,-7,5,12,08,88\n")})
    CHECK_THAT(error(text), Contains(decimals));
  CHECK(read(commas, "x y z a b c").rows.size() == 2);
  CHECK(read("500,317;5400000,1;12,018\n").rows[0][0] == 500.317);

  const std::string thousands = " divide the values, and may divide the thousands of numbers, too, in '";
  for (const char* text : {"500 010.25\t5 400 420.36\t99.5\n", "500 310.25 5 400 020.36 99.5\n"})
    CHECK_THAT(error(text), Contains("line 1: blanks" + thousands));
  CHECK_THAT(error("500,310.25,5,400,020.5,99.5\n"), Contains("line 1: commas" + thousands));
  for (const char* cell : {"500'000.25", "500.000,25", "5.400.000",
                           "500\xc2\xa0"
                           "000.25"})
    CHECK_THAT(error("x;y;z\n1;2;3\n4;" + std::string(cell) + ";6\n"),
               Contains("line 3: ") && Contains(" is not a number; thousands must not be divided"));

  // Whole numbers and colours have neither.
  for (const char* text : {"12345,23456,345,128,130,100\n", "123.5 345.5 678.5 128 130 0\n",
                           "500000.5\t5400000.5\t100.5\t128 130 100\n", "0.5 0.25 0.125\n"})
    CHECK(read(text).rows.size() == 1);
}

TEST_CASE("lines before the rows may come again, as where files were joined", "[io]") {
  const ScratchFolder folder;
  const std::string header = "Easting,Northing,Height\r\nm,m,m\r\n";
  const auto file = folder.write("a.csv", header + "1,2,3\r\n" + header + "4,5,6\r\n");
  CHECK(read_table(file, 1).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(findings_of(file).repeated_lines == 2);
  CHECK_THAT(error("x,y,z\n1,2,3\ny,x,z\n"),
             Contains("line 3: 'y' is not a number, and no value of its line is"));
}

TEST_CASE("x on a grid is x", "[io]") {
  // A depth image without and with a fourth value, a row of a height model, a short profile.
  CHECK(error(rows(60, [&](int i) { return number(i) + " 0 1.5"; })).empty());
  CHECK(error(rows(60, [&](int i) { return number(i % 20) + " " + number(i / 20) + " 1.5 7"; })).empty());
  CHECK(error(rows(60, [&](int i) { return number(500000 + i) + " 5400000 312.5 1"; })).empty());
  CHECK(error(rows(9, [&](int i) { return number(i) + " 0 1.5 7"; })).empty());
  CHECK(error(rows(60, [&](int i) { return number(2 * i) + " 0 1.5 7"; })).empty());
  CHECK(error(rows(60, [&](int i) {
          return number(i / 10) + ".5 " + number(i % 10) + ".25 1.75 0.5";
        })).empty());
}

TEST_CASE("columns of the field are x, y and z by their names, also in comments", "[io]") {
  CHECK(names("# id Easting Northing Elevation\n7 1 2 3\n") == Names{"id", "x", "y", "z"});
  CHECK(names("Northing (m),Easting (m),Height (m)\n1,2,3\n") == Names{"y", "x", "z"});
  CHECK(names("# X_m Y_m Z_m\n1 2 3\n") == kThree);
  for (const std::string header :
       {"Points_m_XYZ:0,Points_m_XYZ:1,Points_m_XYZ:2", "Rechtswert;Hochwert;Hoehe",
        "Rechtswert;Hochwert;H\xc3\xb6he", "Rechtswert;Hochwert;H\xf6he [m]", "RD_X RD_Y NAP",
        "field.x,field.y,field.z"})
    CHECK(names(header + "\n1,2,3\n") == kThree);
  CHECK(names("field.x,field.y,field.z,x,y,z\n1,2,3,4,5,6\n") ==
        Names{"field.x", "field.y", "field.z", "x", "y", "z"});
  CHECK(names("# a list\n# ID, X, Y, Z, ERROR, TRACK[] as (IMAGE, POINT)\n# Number of points: 2\n"
              "1 2 3 4 0.5 6 7\n2 3 4 5 0.5\n") == Names{"ID", "x", "y", "z", "ERROR"});
  CHECK(names("//X Y Z Nx Ny Nz\n1 2 3 4 5 6\n") == Names{"x", "y", "z", "nx", "ny", "nz"});
  CHECK(names("# four words of prose\n1 2 3 4\n") == Names{"x", "y", "z", "column_4"});
  const Table plain = read("# by hand\n// and more\n1 2 3 4\n#5 6 7 8\n  // 9\n5 6 7 8\n");
  CHECK(plain.names == Names{"x", "y", "z", "column_4"});
  CHECK(plain.rows == Rows{{1, 2, 3, 4}, {5, 6, 7, 8}});
  check_refused("a.txt",
                {{"# ID LONGITUDE_LOW LATITUDE_LOW ELEVATION_LOW\n1 2 3 4\n", "no columns named x, y and z"},
                 {"# id x y z\n1 2 3 4 5\n", "the row has 5 values, and the comment before it names 4"}});
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
  const Table words = read("Point;X;Y;Z;Code\nP0;1;2;3;TOPO\nP1;4;5;6;\"a;b\"\n");
  CHECK(words.names == kThree);
  CHECK(words.rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read("\"X\",\"Y\",\"Z\"\n\"1\",\"2.5\",\"-3\"\n").rows == Rows{{1, 2.5, -3}});
  CHECK(read("\"1,5\",\"2,5\",\"3,0\"\n").rows == Rows{{1.5, 2.5, 3}});
  const Table empty = read("x,y,z,i\n1,2,3,\n1,2,3,4\n1,,3,NA\n");
  CHECK(std::isnan(empty.rows.at(0)[3]));
  CHECK(std::isnan(empty.rows.at(2)[1]));
  CHECK(std::isnan(empty.rows.at(2)[3]));
  CHECK(read("1,2,3,4\n", "_ x y z").rows == Rows{{2, 3, 4}});
  CHECK(read("9 1 2 3 4 5\n9 1 2 3\n", "_ x y z ...").rows == Rows{{1, 2, 3}, {1, 2, 3}});
}

TEST_CASE("lines before the header are passed over", "[io]") {
  const std::string before = "Project: Test\nDate: 2020\nUnits: m\n";
  CHECK(read(before + "X Y Z\n1 2 3\n4 5 6\n").rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read("X,Y,Z\nm,m,m\n1,2,3\n").rows == Rows{{1, 2, 3}});
  CHECK(read(before + "1 2 3\n", "x y z").rows == Rows{{1, 2, 3}});
  check_refused("a.txt", {{before + "1 2 3\n", "line 1: 'Project: Test' is neither a header line"}});
}

TEST_CASE("text of more than 10,000 columns is refused", "[io]") {
  std::string header = "x y z", row = "1 2 3";
  for (int i = 3; i < 10'000; ++i) header += " a" + number(i), row += " 1";
  CHECK(names(header + "\n" + row + "\n").size() == 10'000);
  check_refused("a.xyz", {{row + " 1\n", "line 1: more than the 10,000 columns that are read"}});
}

TEST_CASE("a bare count on the first line is what the rows must come to, in each block", "[io]") {
  CHECK(read("2\n1 2 3\n4 5 6\n").rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read("2\n1 2 3\n4 5 6\n1 \r\n7 8 9\n").rows == Rows{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  CHECK(read("0\n").rows.empty());
  CHECK(names("1\n1 2 3 40\n") == Names{"x", "y", "z", "intensity"});
  CHECK(names("1\n1 2 3 9 8 7\n") == Names{"x", "y", "z", "red", "green", "blue"});
  CHECK(names("1\n1 2 3 -40 9 8 7\n") == Names{"x", "y", "z", "intensity", "red", "green", "blue"});
  CHECK(names("1 2 3 -40 9 8 7\n").back() == "column_7");
  check_refused("a.pts", {{"2\n", "line 1: "},
                          {"3\n1 2 3\n4 5 6\n", "line 3: the file ends here with fewer rows than the 3 that"},
                          {"1\n1 2 3\n4 5 6\n7 8 9\n", "line 3: more rows than the 1 that"},
                          {"1\n1 2 3\n2\n4 5 6\n", "line 4: the file ends here with fewer rows than the 2"}});
}

TEST_CASE("decimal commas, exponents of Fortran and what is not a number for Microsoft are numbers", "[io]") {
  CHECK(read("1,5 2,25 3\n4,5 -5 6,0\n").rows == Rows{{1.5, 2.25, 3}, {4.5, -5, 6}});
  CHECK(read("x;y;z\n1,5;2,25;3\n").rows == Rows{{1.5, 2.25, 3}});
  const Rows odd = read("1.0D+02 2.5d-1 -1.#IND\n1.#QNAN 1.#INF -1.#INF00\n").rows;
  CHECK((odd[0][0] == 100 && odd[0][1] == 0.25));
  CHECK((std::isnan(odd[0][2]) && std::isnan(odd[1][0])));
  CHECK(odd[1][1] == std::numeric_limits<double>::infinity());
  CHECK(odd[1][2] == -std::numeric_limits<double>::infinity());
  for (const char* wrong : {"1.#X 2 3\n", "1 2 3,4,5\n", "1 2 1D2D3\n"}) CHECK(error(wrong) != "");
  const Rows extreme = read("nan inf -inf\nNaN 1e999 1e-999\n0.1 +3 -0\n").rows;
  for (const std::size_t row : {0, 1}) CHECK((std::isnan(extreme.at(row)[0]) && std::isinf(extreme[row][1])));
  CHECK((extreme[0][2] < 0 && extreme[1][2] == 0 && extreme.at(2)[0] == 0.1));
}

TEST_CASE("columns of a header may be given other names", "[io]") {
  const std::string text = "Nord,Ost,Hoehe,I\n1,2,3,4\n";
  const Table table = read(text, "x=Ost y=Nord z=Hoehe");
  CHECK(table.names == Names{"y", "x", "z", "I"});
  CHECK(table.rows == Rows{{1, 2, 3, 4}});
  CHECK_THAT(error(text), Contains("but 'Nord', 'Ost', 'Hoehe', 'I'; --columns x=...,y=...,z=..."));
  CHECK_THAT(error(text, "x=East y=Nord z=Hoehe"), Contains("no column for 'x=East'"));
}

TEST_CASE("a header line alone is an empty scan, comments alone are none", "[io]") {
  CHECK(read("x,y,z\n").rows.empty());
  CHECK(error("# nothing\n\n") != "");
  CHECK(error("\n") != "");
}

TEST_CASE("a row that does not fit is an error that names its line", "[io]") {
  const std::string twice = "gr\xc3\xb6\xc3\x9f\xc2\x9b\xff";
  check_refused("a.txt", {{"1 2 3\n\n4 5\n", "line 3: fewer values than the 3 columns"},
                          {"1 2 3\n4 5 6 7\n", "line 2: more values than the 3 columns"},
                          {"1 2 3\n4 5 six\n", "line 2: 'six' is not a number"},
                          {"1 2 three\n", "line 1: 'three' is not a number"},
                          {"1,2,3\n4,5,6,,\n", "line 2: more values"},
                          {"1,5;2,5;x\n", "line 1: 'x' is not a number"},
                          {"1 2\n", "line 1: 2 values"},
                          {"a b c\n1 2 3\n", "line 1: no columns named x, y and z"},
                          {"x y z x\n1 2 3 4\n", "line 1: a second column 'x'"},
                          {"x y z " + twice + " " + twice + "\n",
                           "line 1: a second column 'gr\xc3\xb6\xc3\x9f"
                           "?"
                           "?'"},
                          {"x y z\n1 2 3 4\n", "line 2: more values"},
                          {"EDITION 0.7\n1 2 3\n", "line 1: 'EDITION 0.7' is neither a header"},
                          {"1 2 3\r4 5 6\r", "line 1: a carriage return within the line"},
                          {"# x y z\r1 2 3\r\n", "line 1: a carriage return within the line"},
                          {"1 2 3\n4 5 \x01\x02\n",
                           "line 2: '?"
                           "?' is not a number"}});
  CHECK_THAT(error("1 2 3\n", "x y z w"), Contains("line 1: fewer"));
  CHECK_THAT(error("1 2 3\n", "x y"), Contains("no columns"));
}

TEST_CASE("lines of text stay whole across buffers and batches", "[io]") {
  const ScratchFolder folder;
  constexpr int kRows = 120'000;
  const std::string text = rows(kRows, [](int i) { return number(i) + ", 0.5, -" + number(i) + "\r"; });
  check_rows(folder.write("a.csv", text), kRows, [](double i) { return std::vector<double>{i, 0.5, -i}; });
}

}  // namespace

// A beginning is complete where a row ends, and a counted block.
std::vector<WholeFile> text_files() {
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

namespace {

// ---- PTX

// Turned by a quarter about z, and moved.
const std::string kPose = "10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n";
const std::string kStill = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

TEST_CASE("rays of PTX have the pose of their ptx_block, and those without a return no coordinates", "[io]") {
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

// A ptx_block of three rays, which lie one apart from `first` on along x.
std::string ptx_block(const std::string& place, const std::string& matrix, double first = 1) {
  std::string text = "3\n1\n" + place + "\n1 0 0\n0 1 0\n0 0 1\n" + matrix + "\n";
  for (int i = 0; i < 3; ++i) text += std::to_string(first + i) + " 2 3 0.5\n";
  return text;
}

const std::string kUnturned = "1 0 0 0\n0 1 0 0\n0 0 1 0\n";

TEST_CASE("a matrix of PTX is a pose, as in a list of files", "[io]") {
  const std::string rays = "the matrix by columns, ", odd = rays + "the matrix of a pose does not turn";
  check_refused("a.ptx", {{ptx_block("0 0 0", "1 0 0 7\n0 1 0 8\n0 0 1 9\n0 0 0 1"),
                           "line 10: of " + rays + "the last row of a pose is not 0 0 0 1"},
                          {ptx_block("0 0 0", "0 0 0 0\n0 0 0 0\n0 0 0 0\n7 8 9 1"), odd},
                          {ptx_block("0 0 0", "1 0 0 0\n0 1 0 0\n0 0 -1 0\n7 8 9 1"), odd},
                          {ptx_block("0 0 0", "2 0 0 0\n0 1 0 0\n0 0 1 0\n7 8 9 1"), odd},
                          {ptx_block("7 8 9", kUnturned + "7 8 9 1") +
                               ptx_block("0 0 0", "1 0 0 7\n0 1 0 8\n0 0 1 9\n0 0 0 1"),
                           "line 23: "}});
  const ScratchFolder folder;
  const std::string zeros = "0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n";
  const std::string empty = "0\n0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + zeros;
  CHECK(read_table(folder.write("a.ptx", empty + ptx_block("0 0 0", "2 0 0 0\n0 2 0 0\n0 0 2 0\n7 8 9 1")))
            .rows[0] == std::vector<double>{9, 12, 15, 0.5, 1});
}

TEST_CASE("PTX: a scanner position that is not the place of the matrix is found", "[io]") {
  const ScratchFolder folder;
  const auto other_places = [&](const std::string& text) {
    return findings_of(folder.write("a.ptx", text)).other_places;
  };
  CHECK(other_places(ptx_block("7 8 9", kUnturned + "7 8 9.5 1")) == 0);  // rounded, to half a step
  CHECK(other_places(ptx_block("7 8 9", kUnturned + "7 8 11 1")) == 1);
  CHECK(other_places(ptx_block("7 8 9", kUnturned + "7 8 9 1") + ptx_block("0 0 0", kUnturned + "7 8 9 1")) ==
        1);
}

}  // namespace

// A beginning is complete where a ptx_block ends.
std::vector<WholeFile> ptx_files() {
  return {{.name = "grey.ptx",
           .bytes = "2\n1\n" + kPose + "1 2 3 0.5\n0 0 0 0.25\n1\n1\n" + kStill + "4 5 6 1\n",
           .complete_from = 0},
          {.name = "colours.ptx",
           .bytes = "1\n2\n" + kStill + "1 2 3 0.5 255 0 300\n4 5 6 0.5 1 2 3\n0\n5\n" + kPose,
           .complete_from = 0}};
}

}  // namespace lacuna::test
