// SPDX-License-Identifier: Apache-2.0
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
namespace {

const std::string kAscii =
    "solid two triangles\n  facet normal 0 0 1\n    outer loop\n      vertex 1 2 3\n      vertex 4 5 6e0\n"
    "      vertex 7 8 9\n    endloop\n  endfacet\n\n  facet normal 0 1 0\n    outer loop\n      vertex 3 2 "
    "1\n"
    "      vertex 6 5 4\n      vertex 9 8 7\n    endloop\n  endfacet\nendsolid two triangles\n";

const Rows kRows = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {3, 2, 1}, {6, 5, 4}, {9, 8, 7}};

std::string binary(const std::string& title) {
  Bytes bytes;
  bytes << std::uint32_t{2};
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (i % 3 == 0) bytes << 99.f << 98.f << 97.f;
    for (const double value : kRows[i]) bytes << static_cast<float>(value);
    if (i % 3 == 2) bytes << std::uint16_t{7};
  }
  std::string header = title;
  header.resize(80, ' ');
  return header + bytes.str();
}

std::vector<WholeFile> whole_files() {
  const std::string plain = binary("made by hand"), like_text = binary("solid, yet binary");
  // Without its last words, the name of the solid, an ASCII file is complete.
  return {{.name = "plain.stl", .bytes = plain, .complete_from = plain.size()},
          {.name = "like_text.stl", .bytes = like_text, .complete_from = like_text.size()},
          {.name = "ascii.stl", .bytes = kAscii, .complete_from = kAscii.rfind("endsolid") + 8}};
}

}  // namespace

TEST_CASE("STL: the vertices of the triangles are rows, ASCII and binary", "[io]") {
  const ScratchFolder folder;
  for (const std::size_t max_rows : {1u, 2u, 1000u}) {
    for (const std::string& content :
         {kAscii, binary("made by hand"), binary("solid, yet binary"), binary("1 2 3\n")}) {
      const Table table = read_table(folder.write("a.xyz", content), max_rows);
      CHECK(table.names == std::vector<std::string>{"x", "y", "z"});
      CHECK(table.rows == kRows);
    }
  }
  const auto ascii = open_scan(folder.write("a", kAscii), {});
  CHECK(ascii->format() == "STL, ascii");
  CHECK(!ascii->expected_rows());
  CHECK(ascii->layout().find("x")->type == Scalar::kFloat64);
  const auto reader = open_scan(folder.write("a", binary("")), {});
  CHECK(reader->format() == "STL, binary");
  CHECK(reader->expected_rows() == 6u);
  CHECK(reader->layout().find("x")->type == Scalar::kFloat32);
}

TEST_CASE("STL: several solids, capitals and CR LF are accepted, and a solid may be empty", "[io]") {
  const ScratchFolder folder;
  std::string dos;
  for (const char c : kAscii)
    dos += c == '\n' ? std::string("\r\n") : std::string(1, static_cast<char>(std::toupper(c)));
  CHECK(read_table(folder.write("a.stl", dos)).rows == kRows);
  CHECK(read_table(folder.write("a.stl", "\n" + kAscii + kAscii)).rows.size() == 12);
  CHECK(read_table(folder.write("a.stl", "solid\nendsolid")).rows.empty());
  Bytes nothing;
  nothing << std::uint32_t{0};
  CHECK(read_table(folder.write("a.stl", std::string(80, ' ') + nothing.str())).rows.empty());
}

TEST_CASE("STL: points as text are not taken for it", "[io]") {
  const ScratchFolder folder;
  CHECK(open_scan(folder.write("a", "solid x y z\n1 2 3 4\n"), {})->format() == "text");
  CHECK(open_scan(folder.write("a", "solidity x y z\n1 2 3 4\n"), {})->format() == "text");
}

TEST_CASE("STL: what stands at a wrong place is an error that names it, and so is a wrong size", "[io]") {
  const std::string facet = "solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\n";
  check_refused(
      "a.stl",
      {{"solid", "line 1: the file ends here within a solid"},
       {"solid\nfacet normal 0 0 1\nvertex 1 2 3\n", "line 3: a vertex outside of a loop"},
       {"solid\nfacet\nfacet\n", "line 3: 'facet' is not expected here; allowed are 'outer loop'"},
       {facet + "vertex 1 2\n", "line 5: fewer values than needed; 'vertex x y z'"},
       {facet + "vertex 1 2 3 4\n", "line 5: more values"},
       {facet + "vertex 1 2 three\n", "line 5: 'three' is not a number"},
       {facet + "endloop\n", "line 5: 1 vertices of a facet; three are needed"},
       {facet + "vertex 1 2 3\nvertex 1 2 3\nvertex 1 2 3\n", "line 7: a vertex outside of a loop"},
       {facet + "triangle\n", "line 5: 'triangle' is not expected here; allowed are 'vertex'"},
       {"solid\nendsolid\n1 2 3\n", "line 3: '1' is not expected here; allowed are 'solid'"},
       {binary("solid") + "1", "byte 185: neither ASCII nor a binary STL of 2 triangles, which has 184"}});
}

TEST_CASE("STL: rows stay whole across buffers and batches", "[io]") {
  const ScratchFolder folder;
  constexpr std::uint32_t kTriangles = 30'000;
  Bytes bytes;
  bytes << kTriangles;
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    bytes << 0.f << 0.f << 1.f;
    for (std::uint32_t k = 0; k < 3; ++k) bytes << static_cast<float>(3 * i + k) << 0.5f << -1.f;
    bytes << std::uint16_t{0};
  }
  const auto file = folder.write("a.stl", std::string(80, '\0') + bytes.str());
  check_rows(file, 3 * kTriangles, [](double i) { return std::vector<double>{i, 0.5, -1}; });
}

TEST_CASE("STL: a broken file gives one error or all its rows", "[io]") {
  check_broken_files(whole_files(), 4);
}

TEST_CASE("STL: many broken files give one error or all their rows", "[io][.slow]") {
  check_many_broken_files(whole_files(), 4);
}

}  // namespace lacuna::test
