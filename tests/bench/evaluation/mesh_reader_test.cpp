// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loops_reader.hpp"
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
using namespace evaluation;

namespace {

using Triangles = std::vector<Triangle>;

const std::string kFour = vertices(4) + "property uchar red\n";

std::string four_rows() {
  return "0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n";
}

Bytes& four_rows(Bytes& bytes) {
  for (int i = 0; i < 4; ++i) bytes << 0.f << 1.f << 2.f << std::uint8_t{1};
  return bytes;
}

// Everything that may stand around the corners: an element before the faces and one after, a scalar and a
// list of floats in each face. A square, a triangle, a line and nothing.
const std::string kCrowded = kFour +
                             "element edge 1\nproperty int vertex1\n"
                             "element face 4\nproperty float area\nproperty list uchar float texcoord\n"
                             "property list uchar int vertex_indices\nproperty uchar flag\n"
                             "element last 1\nproperty list short double values\n";

std::string crowded_binary(std::endian order) {
  using U8 = std::uint8_t;
  Bytes bytes(order);
  four_rows(bytes) << 7;
  bytes << 0.5f << U8{2} << 1.f << 2.f << U8{4} << 0 << 1 << 2 << 3 << U8{9};
  bytes << 0.5f << U8{0} << U8{3} << 3 << 2 << 1 << U8{9};
  bytes << 0.5f << U8{0} << U8{2} << 3 << 2 << U8{9};
  bytes << 0.5f << U8{0} << U8{0} << U8{9};
  bytes << std::int16_t{1} << 1e300;
  return ply_header(kCrowded, ply_format(order)) + bytes.str();
}

const std::string kCrowdedAscii = ply_header(kCrowded) + four_rows() +
                                  "7\n0.5 2 1 2.5 4 0 1 2 3 9\n0.5 0 3 3 2 1 9\n0.5 0 2 3 2 9\n0.5 0 0 9\n"
                                  "1 5\n";

const Triangles kCrowdedTriangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 1}};

void visit_triangles(const fs::path& file, std::size_t, std::uint64_t most, const PointVisitor& visit) {
  const Triangles triangles = read_triangles(file);
  if (triangles.size() > most) throw std::logic_error("more triangles than the file can hold");
  for (const Triangle& corners : triangles) {
    for (const std::uint64_t corner : corners)
      if (corner > most) throw std::logic_error("a corner is no vertex");
    visit({double(corners[0]), double(corners[1]), double(corners[2])});
  }
}

std::vector<WholeFile> whole_files() {
  const std::string little = crowded_binary(std::endian::little), big = crowded_binary(std::endian::big);
  const std::size_t without_end = kCrowdedAscii.size() - 1;  // of the last line
  return {{.name = "a.ply", .bytes = kCrowdedAscii, .complete_from = without_end, .read = visit_triangles},
          {.name = "little.ply", .bytes = little, .complete_from = little.size(), .read = visit_triangles},
          {.name = "big.ply", .bytes = big, .complete_from = big.size(), .read = visit_triangles}};
}

}  // namespace

TEST_CASE("polygons come as fans of triangles, whatever stands around them, in every encoding", "[io]") {
  const ScratchFolder folder;
  for (const std::string& content :
       {kCrowdedAscii, crowded_binary(std::endian::little), crowded_binary(std::endian::big)}) {
    CHECK(read_triangles(folder.write("a.ply", content)) == kCrowdedTriangles);
  }
}

TEST_CASE("a file without a mesh is reported with the place and what is allowed", "[io]") {
  const ScratchFolder folder;
  const std::string mesh = ply_header(kFour + kFace) + four_rows();
  const std::string floats = "element face 0\nproperty list uchar float vertex_indices\n";
  check_reasons({{ply_header(kFour) + four_rows(), "no element 'face'"},
                 {ply_header(kFour) + four_rows(), "line 8"},
                 {ply_header(kFace) + "3 0 1 2\n", "no element 'vertex'"},
                 {ply_header(kFour + floats) + four_rows(), "no list of integers named 'vertex_indices'"},
                 {mesh + "3 0 1 4\n", "face 0 (from 0): vertex 4; the file has 4, counted from 0"},
                 {mesh + "3 0 1 -1\n", "vertex -1"},
                 {mesh + "4 0 1 2\n", "line 15: fewer values"}},
                [&](const std::string& content) {
                  return error_of([&] { read_triangles(folder.write("a.ply", content)); });
                });
}

TEST_CASE("a broken mesh gives one error or all its triangles", "[io]") {
  check_broken_files(whole_files(), 2);
}

TEST_CASE("many broken meshes give one error or all their triangles", "[io][.slow]") {
  check_many_broken_files(whole_files(), 2);
}

}  // namespace lacuna::test
