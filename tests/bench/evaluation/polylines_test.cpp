// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/evaluation.hpp"
#include "bench/evaluation/loops_reader.hpp"
#include "tests/io/io_support.hpp"
#include "tests/tools/matching/drawn.hpp"

namespace lacuna::evaluation {
namespace {

// A PLY of so many vertices, with edges.
std::string ply(const std::string& vertices, std::size_t count, const std::string& edges) {
  const auto edge_count = std::count(edges.begin(), edges.end(), '\n');
  return test::ply_header(test::vertices(count) + "element edge " + std::to_string(edge_count) +
                          "\nproperty int vertex1\nproperty int vertex2\n") +
         vertices + edges;
}

std::string zeros(std::size_t count) {
  std::string rows;
  for (std::size_t i = 0; i < count; ++i) rows += "0 0 0\n";
  return rows;
}

}  // namespace

TEST_CASE("loops follow the edges of a PLY file, whatever the order of its edges") {
  const ScratchFolder folder;
  const auto file = folder.write("a.ply", ply(zeros(8), 8, "5 3\n0 7\n3 1\n7 2\n1 5\n2 0\n"));
  CHECK(has_polylines(file));
  CHECK(read_polylines(file) == std::vector<matching::LoopIds>{{0, 7, 2}, {1, 3, 5}});
}

TEST_CASE("lines that are no closed loops are refused in one line that names the vertex or the edge") {
  const ScratchFolder folder;
  test::check_reasons(
      {{"0 1\n1 2\n", "vertex 0 (from 0) has one edge; a loop is closed"},
       {"0 1\n1 2\n2 0\n0 3\n", "vertex 0 (from 0) has more than two edges; a loop does not branch"},
       {"0 1\n1 5\n", "edge 1 (from 0): vertex 5; the file has 5, counted from 0"},
       {"0 -1\n", "edge 0 (from 0): vertex -1"}},
      [&](const std::string& edges) {
        return test::error_of([&] { read_polylines(folder.write("a.ply", ply(zeros(5), 5, edges))); });
      });
  CHECK_THROWS_WITH(has_polylines(folder.write("b.ply", test::ascii_ply(""))), Contains("has no loops"));
}

TEST_CASE("a polyline near a true loop finds it, and one elsewhere is false, though no vertex is a point") {
  const ScratchFolder folder;
  // A sheet of 30 x 30 points, a unit apart. The true loop is the square from (10, 10) to (14, 14).
  std::string rows;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) rows += std::to_string(x) + " " + std::to_string(y) + " 0\n";
  const auto scan = folder.write("scan.xyz", rows);
  std::string truth_row, vertices, edges;
  const auto square = places_around(0, 0, 4, 4);
  for (const auto& [x, y] : square) truth_row += std::to_string((10 + y) * 30 + 10 + x) + " ";
  for (int loop = 0; loop < 2; ++loop) {
    for (int i = 0; i < 16; ++i) {
      vertices += std::to_string(10.3 + square[i][0] + 12 * loop) + " " +
                  std::to_string(10.3 + square[i][1]) + " 0.2\n";
      edges += std::to_string(16 * loop + i) + " " + std::to_string(16 * loop + (i + 1) % 16) + "\n";
    }
  }
  const auto truth_file = folder.write("true.txt", truth_row + "\n");
  Result result = read_result(folder.write("found.ply", ply(vertices, 32, edges)));
  const Truth truth = read_truth(truth_file, {io::ScanInput(scan)}, result);
  CHECK(truth.positions.size() == 900 + 32);
  CHECK(truth.spacing == Approx(1));
  const Evaluation evaluation = evaluate(result, truth, {});
  REQUIRE(evaluation.loops.loops.size() == 2);
  CHECK(evaluation.loops.loops[0].verdict == EdgeDecision::kFound);
  CHECK(evaluation.loops.loops[1].verdict == EdgeDecision::kFalse);
}

TEST_CASE("a list of loops has to follow its curves, and a run's loops, which do, may have long edges") {
  const ScratchFolder folder;
  std::string rows,
      ids;  // 40 pairs of near points, 100 apart: the loop goes through the first of each, then the others
  for (int pair = 0; pair < 40; ++pair)
    for (int point = 0; point < 2; ++point) rows += std::to_string(100 * pair + point) + " 0 0\n";
  for (int point = 0; point < 2; ++point)
    for (int pair = 0; pair < 40; ++pair) ids += std::to_string(2 * pair + point) + " ";
  const auto scan = folder.write("scan.xyz", rows);
  Result result = read_result(folder.write("found.txt", ids + "\n"));
  const Truth truth = read_truth(folder.write("true.txt", ids + "\n"), {io::ScanInput(scan)}, result);
  Truth dense = truth;
  dense.spacing = 1;
  CHECK_THROWS_WITH(evaluate(result, dense, {}),
                    Catch::Contains("its points are not in order along a curve"));
  result.points = dense.positions.size();
  CHECK_NOTHROW(evaluate(result, dense, {}));
}

}  // namespace lacuna::evaluation
