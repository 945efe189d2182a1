// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loops_reader.hpp"

#include "tests/io/broken_files.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/tools/matching/drawn.hpp"

namespace lacuna::test {
using namespace evaluation;

// ---- Loops by ids

namespace {

using Loops = std::vector<LoopIds>;

// An id and a loop a line, each at 0 0 0.
std::string loops_ply(const std::string& rows) {
  return ascii_ply(rows, kXyz + "property double scalar_id\nproperty int scalar_loop\n");
}

// A file of loops of this name and each content is refused.
void check_loops_refused(const std::string& name, const std::vector<Wrong>& cases) {
  const ScratchFolder folder;
  check_reasons(cases, [&](const std::string& content) {
    return error_of([&] { read_loops(folder.write(name, content)); });
  });
}

}  // namespace

TEST_CASE("loops as text are a line each, without comments and blank lines", "[io]") {
  const ScratchFolder folder;
  CHECK(read_loops(folder.write("a.loops.txt",
                                "# one loop per line\n3 1 2\n\n  #4 5 6\n 18446744073709551615\t7 \r\n8")) ==
        Loops{{3, 1, 2}, {18446744073709551615u, 7}, {8}});
  CHECK(read_loops(folder.write("none.loops.txt", "# none\n")).empty());
  CHECK(read_loops(folder.write("empty.loops.txt", "")).empty());
}

TEST_CASE("the comment before a loop is its name, that of the file is none", "[io]") {
  const ScratchFolder folder;
  const auto named = [&](const std::string& text) {
    std::vector<std::string> names;
    for (const NamedLoopIds& loop : read_true_rows(folder.write("a.loops.txt", text)).loops)
      names.push_back(loop.name);
    return names;
  };
  using Names = std::vector<std::string>;
  const std::string head = std::string(kLoopsTextMark) + "a.ply\n";
  CHECK(named(head + "1 2 3\n# window\n4 5\n6 7\n  #shadow  of\tsofa, door \r\n8 9\n") ==
        Names{"", "window", "", "shadow of sofa, door"});
  CHECK(named("# no\n\n# yes\n\n1 2\n#\n3\n# of none\n") == Names{"yes", ""});
  CHECK(named("# " + std::string(300, 'x') + "\n1\n#" + std::string(300, 'x') + "\n2\n") == Names{"", ""});
  CHECK(read_true_rows(folder.write("a.ply", loops_ply("0 0 0 5 0\n"))).loops.at(0).name.empty());
}

TEST_CASE("a line that begins with a mark is neither a loop nor a name", "[io]") {
  const ScratchFolder folder;
  std::ostringstream many;
  many << "#step";
  for (int id = 0; id < 1000; ++id) many << ' ' << id;
  const std::string file = folder.write("a.txt", "# head\n1 2 3\n#step 4 5 4\n 7 8\n" + many.str() +
                                                     "\n9\n#steps 1 2\n# step 3\n#narrow 6 7 8\n");
  CHECK(read_loops(file) == Loops{{1, 2, 3}, {7, 8}, {9}});
  const TrueRows rows = read_true_rows(file);
  REQUIRE(rows.loops.size() == 4);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK_FALSE(rows.loops[i].is_narrow);
    CHECK(rows.loops[i].name == (i == 0 ? "head" : ""));
  }
  CHECK(rows.loops[3].is_narrow);
  CHECK(rows.loops[3].ids == LoopIds{6, 7, 8});
  REQUIRE(rows.steps.size() == 2);
  CHECK(rows.steps[0] == LoopIds{4, 5, 4});
  CHECK(rows.steps[1].size() == 1000);
  CHECK(read_true_rows(folder.write("none.txt", "1 2 3\n")).steps.empty());
  CHECK(read_true_rows(folder.write("a.ply", loops_ply("0 0 0 5 0\n"))).steps.empty());
  const std::string bad = folder.write("b.txt", "1 2\n#step 3 x\n");
  CHECK_THAT(error_of([&] { read_true_rows(bad); }), Contains("line 2: 'x' is not a point id"));
  CHECK(read_loops(bad) == Loops{{1, 2}});
}

TEST_CASE("loops as text that are no ids are reported with their line", "[io]") {
  const ScratchFolder folder;
  check_loops_refused("a.txt", {{"# ids\n1 2 3\n4 5 -6\n", "a.txt: line 3: '-6' is not a point id"},
                                {"1 2 3 # a hole\n", "line 1: '#'"},
                                {std::string("\1\2\0\xff", 4), "line 1: '???"}});
  CHECK_THAT(error_of([&] { read_loops(folder / "missing.txt"); }), Contains("cannot be opened"));
  CHECK_THAT(error_of([&] { read_loops(folder.path()); }), Contains("is a folder"));
}

TEST_CASE("loops.ply has its loops one after the other", "[io]") {
  const ScratchFolder folder;
  const auto file = folder.write("a.ply", loops_ply("0 0 0 5 0\n0 0 0 5000000001 0\n0 0 0 2 1\n"));
  CHECK(read_loops(file) == Loops{{5, 5'000'000'001}, {2}});
  CHECK(read_ids(file) == std::vector<std::uint64_t>{5, 5'000'000'001, 2});
  CHECK(read_loops(folder.write("a.ply", loops_ply(""))).empty());
}

TEST_CASE("a PLY without loops, or with broken ones, is reported with its place", "[io]") {
  check_loops_refused("a.ply", {{ascii_ply(""), "no property 'scalar_id'"},
                                {loops_ply("0 0 0 1 0\n0 0 0 1 2\n"), "vertex 1 (from 0): loop 2 where 1"},
                                {loops_ply("0 0 0 1.5 0\n"), "'scalar_id' is 1.5"},
                                {loops_ply("0 0 0 nan 0\n"), "'scalar_id' is nan"},
                                {loops_ply("0 0 0 1e17 0\n"), "whole number"},
                                {loops_ply("0 0 0 1 -1\n"), "'scalar_loop' is -1"}});
}

// ---- Lines

namespace {

// A PLY of so many vertices at one place, with edges.
std::string polylines_ply(std::size_t count, const std::string& edges) {
  std::string text =
      ply_header(vertices(count) + "element edge " + std::to_string(std::ranges::count(edges, '\n')) +
                 "\nproperty int vertex1\nproperty int vertex2\n");
  for (std::size_t i = 0; i < count; ++i) text += "0 0 0\n";
  return text + edges;
}

}  // namespace

TEST_CASE("loops follow the edges of a PLY file, whatever the order of its edges") {
  const ScratchFolder folder;
  const auto file = folder.write("a.ply", polylines_ply(8, "5 3\n0 7\n3 1\n7 2\n1 5\n2 0\n"));
  CHECK(has_polylines(file));
  CHECK(read_polylines(file) == std::vector<matching::LoopIds>{{0, 7, 2}, {1, 3, 5}});
}

TEST_CASE("lines that are no closed loops are refused in one line that names the vertex or the edge") {
  const ScratchFolder folder;
  check_reasons(
      {{"0 1\n1 2\n", "vertex 0 (from 0) has one edge; a loop is closed"},
       {"0 1\n1 2\n2 0\n0 3\n", "vertex 0 (from 0) has more than two edges; a loop does not branch"},
       {"0 1\n1 5\n", "edge 1 (from 0): vertex 5; the file has 5, counted from 0"},
       {"0 -1\n", "edge 0 (from 0): vertex -1"}},
      [&](const std::string& edges) {
        return error_of([&] { read_polylines(folder.write("a.ply", polylines_ply(5, edges))); });
      });
  CHECK_THROWS_WITH(has_polylines(folder.write("b.ply", ascii_ply(""))), Contains("has no loops"));
}

// ---- Meshes

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

// ---- The true loops of a mesh

namespace {

using Ids = std::vector<std::uint64_t>;

// A disc of n triangles around its centre. With `torn`, every triangle brings points of its own, so that the
// disc hangs together by coordinates only. Returns the ids of its edge.
Ids add_disc(Drawing& drawing, std::vector<Triangle>& triangles, std::uint64_t n, double x, bool torn) {
  const LoopIds rim = drawing.ring(n, x, 0);
  const std::uint64_t centre = drawing.point(x, -0.0);
  for (std::uint64_t i = 0; i < n; ++i) {
    Triangle triangle = {centre, rim[i], rim[(i + 1) % n]};
    if (torn) {
      for (std::uint64_t& corner : triangle) {
        const Eigen::Vector3d p = drawing.positions[corner];
        corner = drawing.point(p.x(), p.y() + 0.0, p.z());
      }
    }
    triangles.push_back(triangle);
  }
  return rim;
}

// 5 x 5 squares of points a unit apart, without some of them. Ids count as in plane(6), though the mesh has
// the points in the order of `ids`.
std::vector<TrueLoop> sheet_without(const std::vector<std::array<std::uint64_t, 2>>& missing,
                                    const Ids& ids) {
  std::vector<Eigen::Vector3d> positions;
  Ids place(36);
  for (const std::uint64_t id : ids) {
    place[id] = positions.size();
    positions.push_back(plane(6).positions[id]);
  }
  std::vector<Triangle> triangles;
  for (std::uint64_t y = 0; y < 5; ++y) {
    for (std::uint64_t x = 0; x < 5; ++x) {
      if (std::find(missing.begin(), missing.end(), std::array{x, y}) != missing.end()) continue;
      const std::uint64_t a = 6 * y + x;
      triangles.push_back({place[a], place[a + 1], place[a + 7]});
      triangles.push_back({place[a], place[a + 7], place[a + 6]});
    }
  }
  auto loops = mesh_boundary(triangles, stand_ins(positions), positions);
  for (TrueLoop& loop : loops) {
    for (std::uint64_t& vertex : loop.vertices) vertex = ids[vertex];
    std::sort(loop.vertices.begin(), loop.vertices.end());
  }
  std::sort(loops.begin(), loops.end(),
            [](const TrueLoop& one, const TrueLoop& other) { return one.vertices < other.vertices; });
  return loops;
}

// In another order each time.
Ids shuffled_ids(std::uint64_t seed) {
  Random random(seed);
  Ids ids(36);
  std::iota(ids.begin(), ids.end(), 0u);
  for (std::int64_t i = 35; i > 0; --i) std::swap(ids[i], ids[random.whole(0, i)]);
  return ids;
}

}  // namespace

TEST_CASE("the boundary of two discs is two loops, also where their triangles share no vertex") {
  for (const bool torn : {false, true}) {
    Drawing drawing;
    std::vector<Triangle> triangles;
    const Ids first = add_disc(drawing, triangles, 12, 0, torn);
    const Ids second = add_disc(drawing, triangles, 20, 50, torn);
    const auto loops = mesh_boundary(triangles, stand_ins(drawing.positions), drawing.positions);
    REQUIRE(loops.size() == 2);
    CHECK(loops[0].vertices == first);
    CHECK(loops[0].edges.size() == 12);
    CHECK(loops[1].vertices == second);
    CHECK(loops[1].edges.size() == 20);
    for (const TrueLoop& loop : loops) {
      for (std::size_t i = 0; i < loop.edges.size(); ++i)
        CHECK(loop.edges[i][1] == loop.edges[(i + 1) % loop.edges.size()][0]);
    }
  }
}

TEST_CASE("holes that touch at several vertices stay apart, whatever lies between them") {
  // The square in the middle hangs at its four corners.
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto loops = sheet_without({{1, 2}, {3, 2}, {2, 1}, {2, 3}}, shuffled_ids(seed));
    REQUIRE(loops.size() == 5);
    CHECK(loops[1].vertices == Ids{8, 9, 14, 15});
    CHECK(loops[2].vertices == Ids{13, 14, 19, 20});
    CHECK(loops[3].vertices == Ids{15, 16, 21, 22});
    CHECK(loops[4].vertices == Ids{20, 21, 26, 27});
  }
}

TEST_CASE("the order of triangles and of their corners does not change loops") {
  Random random(5);
  std::vector<Triangle> triangles;
  std::vector<Eigen::Vector3d> positions = plane(12).positions;
  for (std::uint64_t y = 0; y < 11; ++y) {
    for (std::uint64_t x = 0; x < 11; ++x) {
      if (random.chance(0.3)) continue;
      const std::uint64_t a = 12 * y + x;
      triangles.push_back({a, a + 1, a + 13});
      triangles.push_back({a, a + 13, a + 12});
    }
  }
  const auto expected = mesh_boundary(triangles, stand_ins(positions), positions);
  std::size_t edges = 0;
  for (const TrueLoop& loop : expected) {
    CHECK(loop.vertices.size() == loop.edges.size());
    CHECK(std::adjacent_find(loop.vertices.begin(), loop.vertices.end()) == loop.vertices.end());
    edges += loop.edges.size();
  }
  for (int turn = 0; turn < 3; ++turn) {
    std::reverse(triangles.begin(), triangles.end());
    for (Triangle& triangle : triangles) std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
    // The last time every triangle is seen from its other side.
    for (Triangle& triangle : triangles)
      if (turn == 2) std::swap(triangle[0], triangle[1]);
    const auto loops = mesh_boundary(triangles, stand_ins(positions), positions);
    REQUIRE(loops.size() == expected.size());
    std::size_t again = 0;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      CHECK(loops[i].vertices == expected[i].vertices);
      again += loops[i].edges.size();
    }
    CHECK(again == edges);
  }
}

TEST_CASE("a closed mesh, triangles without area and no triangles have no boundary") {
  Drawing drawing;
  for (int i = 0; i < 4; ++i) drawing.point(i == 1, i == 2, i == 3);
  const std::vector<Triangle> closed = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  CHECK(mesh_boundary(closed, stand_ins(drawing.positions), drawing.positions).empty());
  drawing.point(1, 0);  // at the place of 1
  const std::vector<Triangle> flat = {{0, 1, 4}};
  CHECK(mesh_boundary(flat, stand_ins(drawing.positions), drawing.positions).empty());
  CHECK(mesh_boundary({}, {}, {}).empty());
}

}  // namespace lacuna::test
