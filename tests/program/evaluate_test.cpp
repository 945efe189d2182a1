// SPDX-License-Identifier: Apache-2.0
// `lacuna-bench evaluate` as a user calls it: on what `detect` and `synth` write, on meshes, and on what is
// neither.
#include "tests/support/clouds.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"
#include "tests/tools/matching/drawn.hpp"

namespace lacuna::test {
namespace {

nlohmann::json evaluate(const Words& arguments) {
  return json_of(succeed(with(with({"evaluate"}, arguments), {"--json"}), Program::kBench).out);
}

// A plane with three holes and its result.
struct Made {
  ScratchFolder folder;
  std::string scan =
      synth("surface", folder / "made.ply", {"--points", "5000", "--holes", "3", "--hole-radius", "5", "7"});
  std::string truth = (folder / "made.loops.txt").string();
  std::string out = detect(scan, folder / "out").string();
};

// Points of a grid, a unit apart, with numbers as ids. Gaps are squares of n points.
struct Grid {
  struct Gap {
    int x, y, n;
  };
  std::string rows;
  std::map<std::array<int, 2>, int> ids;

  Grid(int width, int height, const std::vector<Gap>& gaps = {}) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto holds = [&](const Gap& gap) {
          return x >= gap.x && x < gap.x + gap.n && y >= gap.y && y < gap.y + gap.n;
        };
        if (std::any_of(gaps.begin(), gaps.end(), holds)) continue;
        rows += std::to_string(x) + " " + std::to_string(y) + " 0\n";
        ids[{x, y}] = static_cast<int>(ids.size());
      }
    }
  }
  std::string around(int x, int y, int width, int height) const {
    std::string line;
    for (const auto& place : matching::places_around(x, y, width, height))
      line += std::to_string(ids.at(place)) + " ";
    return line;
  }
};

const std::string kSquare =
    ply_header(vertices(5) + kFace) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n9 9 9\n4 0 1 2 3\n";

}  // namespace

TEST_CASE("a synthetic surface is evaluated against the truth next to it") {
  const Made made;
  const auto report = evaluate({made.out, made.truth});
  CHECK((report.at("true") == 4 && report.at("found") == 4 && report.at("false") == 0));
  CHECK((report.at("recall") == 1 && report.at("precision") == 1));
  CHECK(report.at("boundary").at("within_tolerance").at("f1") > 0.9);
  CHECK(report.at("spacing") == Approx(0.01).epsilon(0.1));
  CHECK(report.at("true_loops").size() == 4);
  CHECK_THAT(run_bench({"evaluate", made.out, made.truth}).out,
             StartsWith("found 3 of 3 holes and 1 of 1 outer curve, 0 false\n"));
}

TEST_CASE("each true loop is printed with what it is, its size, its place and who found it") {
  const ScratchFolder folder;
  const Grid grid(60, 20, {{5, 5, 9}, {30, 5, 5}});
  const std::string scan = folder.write("scan.xyz", grid.rows);
  const std::string truth = folder.write(
      "true.txt", "# window\n" + grid.around(4, 4, 10, 10) + "\n# shadow of sofa\n" +
                      grid.around(29, 4, 6, 6) + "\n# edge of wall\n" + grid.around(0, 0, 59, 19) + "\n");
  const std::string found =
      folder.write("found.txt", grid.around(4, 4, 10, 10) + "\n" + grid.around(38, 8, 8, 8) + "\n");
  const ProgramResult text = run_bench({"evaluate", found, truth, "--scan", scan});
  CHECK(text.exit_code == 0);
  CHECK_THAT(
      text.out,
      StartsWith("found 1 of 2 holes and 0 of 1 outer curve, 1 false\n\n"
                 "  width of holes, local spacings  below 2  2 to 3  3 to 5  5 to 10  10 and more\n"
                 "  found                            0 of 0  0 of 1  1 of 1   0 of 0       0 of 0\n\n") &&
          Contains("  window               40.0      14.1   9.0 9.0 0.0      40    loop 0\n") &&
          Contains("  edge of wall        156      62.0  29.5 9.5 0.0     156    missed\n") &&
          Contains("  loop 1                      32.0      11.3  42.0 12.0 0.0      32       false\n"));
  const auto report = evaluate({found, truth, "--scan", scan});
  CHECK(report.at("true_loops")[0].at("name") == "window");
  CHECK(report.at("true_loops")[0].at("perimeter") == Approx(40));
  CHECK(report.at("true_loops")[0].at("diameter") == Approx(10 * std::sqrt(2)));
  CHECK(report.at("true_loops")[0].at("kind") == "hole");
  CHECK(report.at("true_loops")[1].at("centre")[0] == Approx(32));
  CHECK((report.at("true_loops")[0].at("width") > 4.5 && report.at("true_loops")[2].at("width").is_null()));
  CHECK(report.at("holes_by_width")[2] == nlohmann::json{{"from", 3}, {"to", 5}, {"true", 1}, {"found", 1}});
  CHECK(report.at("holes_by_width")[4].at("to").is_null());
}

TEST_CASE("the truth is itself found, from either kind of file, without boundary points") {
  const Made made;
  for (const std::string& result : {made.truth, made.out + "/loops.ply"}) {
    const auto report = evaluate({result, made.truth});
    CHECK(report.at("found") == 4);
    CHECK(report.at("boundary").is_null());
    CHECK(report.at("confidence_auc").is_null());
  }
  fs::rename(made.scan, made.folder / "other.ply");
  check_failure(run_bench({"evaluate", made.truth, made.truth}), 1, "--scan must name it");
  CHECK(evaluate({made.truth, made.truth, "--scan", (made.folder / "other.ply").string()}).at("found") == 4);
}

TEST_CASE("the tolerance is in spacings") {
  const ScratchFolder folder;
  std::string rows;  // so few points that places have no spacing of their own
  for (const int y : {0, 3}) rows += line(16).translated({0, double(y), 0}).text();
  const std::string scan = folder.write("rows.xyz", rows);  // neighbours at 1, 1, 2 and 2: spacing 1.5
  const std::string truth = folder.write("true.txt", "0 2 4 6 8 9 7 5 3 1\n");
  const std::string found = folder.write("found.txt", "16 18 20 22 24 25 23 21 19 17\n");
  CHECK(evaluate({found, truth, "--scan", scan}).at("found") == 1);
  CHECK(evaluate({found, truth, "--scan", scan, "--tolerance", "1.99"}).at("found") == 0);
}

TEST_CASE("where points are farther apart, curves of one hole may be, too") {
  const ScratchFolder folder;
  // A coarse grid, and a fine one that decides the spacing of the scan.
  const std::string scan =
      folder.write("scan.xyz", plane(20).text() + plane(40).scaled(0.1).translated({100, 0, 0}).text());
  const Grid coarse(20, 20);
  const std::string truth = folder.write("true.txt", coarse.around(6, 6, 6, 6)),
                    near = folder.write("near.txt", coarse.around(8, 6, 6, 6)),
                    far = folder.write("far.txt", coarse.around(9, 9, 6, 6));
  CHECK(evaluate({near, truth, "--scan", scan}).at("found") == 1);
  CHECK(evaluate({near, truth, "--scan", scan, "--tolerance", "1"}).at("found") == 0);
  CHECK(evaluate({far, truth, "--scan", scan}).at("found") == 0);
}

TEST_CASE("the truth of a mesh is its boundary, without vertices that no face uses") {
  const ScratchFolder folder;
  const std::string mesh = folder.write("square.ply", kSquare);
  const std::string loops = folder.write("found.txt", "0 1 2 3\n4 4 4\n");
  const auto report = evaluate({loops, mesh, "--min-vertices", "4"});
  CHECK((report.at("true") == 1 && report.at("found") == 1 && report.at("false") == 1));
  CHECK(report.at("true_loops")[0].at("vertices") == 4);
  CHECK(report.at("spacing") == Approx((2 + std::sqrt(2)) / 3));
}

TEST_CASE("loops along the steps of density that the truth names are counted apart") {
  const ScratchFolder folder;
  const Grid grid(30, 30);
  const auto around = [&](int x, int y) { return grid.around(x, y, 7, 7); };
  const std::string scan = folder.write("scan.xyz", grid.rows);
  const std::string truth = folder.write("truth.txt", around(1, 1) + "\n#step " + around(18, 18) + "\n");
  const std::string found =
      folder.write("found.txt", around(1, 1) + "\n" + around(18, 18) + "\n" + around(18, 1));
  const auto report = evaluate({found, truth, "--scan", scan});
  CHECK((report.at("found") == 1 && report.at("step") == 1 && report.at("false") == 1));
  CHECK(report.at("precision") == 0.5);
  CHECK(report.at("loop_matches")[1].at("verdict") == "step");
  CHECK(report.at("loop_matches")[1].at("on_step") == 1);
  CHECK(report.at("loop_matches")[0].at("on_step").is_null());
  CHECK_THAT(run_bench({"evaluate", found, truth, "--scan", scan}).out,
             Contains("step of density\n") && Contains("1 false\n  1 loop follows a step of density"));
  const std::string other = folder.write("other.txt", around(1, 1) + "\n#step 1 900\n");
  check_failure(run_bench({"evaluate", found, other, "--scan", scan}), 1, "other.txt: id 900");
}

TEST_CASE("what cannot be evaluated is refused in one line with exit code 1") {
  const Made made;
  const auto refused = [&](const Words& arguments, const std::string& reason) {
    check_failure(run_bench(with({"evaluate"}, arguments)), 1, reason);
  };
  const std::string square = made.folder.write("square.ply", kSquare);
  refused({made.out, square}, "is of a scan of");
  refused({made.out + "/loops.ply", square}, "but the scan has 5 points");
  refused({made.truth, square, "--scan", made.scan}, "no --scan is allowed");
  made.folder.write("far.ply", read_file(made.scan));
  refused({made.truth, made.folder.write("far.loops.txt", "1 2 999999\n")}, "id 999999");
  for (const auto& [holes, reason] :
       {std::pair{"{}", "is not a report of lacuna detect"},
        {R"({"counts": {"points": 1}, "inputs": [], "loops": []})", "both must be of one run"}}) {
    made.folder.write("out/holes.json", holes);
    refused({made.out, made.truth}, reason);
  }
}

}  // namespace lacuna::test
