// SPDX-License-Identifier: Apache-2.0
// `lacuna-bench evaluate` as a user calls it: on what `detect` and `synth` write, on meshes, and on what is
// neither.
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using test::check_failure;
using test::ProgramResult;
using test::run_bench;
using test::run_program;
using test::ScratchFolder;

nlohmann::json evaluate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "evaluate");
  arguments.push_back("--json");
  const ProgramResult result = run_bench(arguments);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  return nlohmann::json::parse(result.out);
}

// A plane with three holes and its result.
struct Made {
  ScratchFolder folder;
  std::string scan = (folder / "made.ply").string();
  std::string truth = (folder / "made.loops.txt").string();
  std::string out = (folder / "out").string();

  Made() {
    REQUIRE(
        run_bench({"synth", "surface", scan, "--points", "5000", "--holes", "3", "--hole-radius", "5", "7"})
            .exit_code == 0);
    REQUIRE(run_program({"detect", scan, "--out", out, "--quiet"}).exit_code == 0);
  }
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
  // The first `most` points around a rectangle, from its lower left corner on.
  std::string around(int x, int y, int width, int height, std::size_t most = 1'000'000) const {
    std::vector<std::array<int, 2>> places;
    for (int i = 0; i < width; ++i) places.push_back({x + i, y});
    for (int i = 0; i < height; ++i) places.push_back({x + width, y + i});
    for (int i = width; i > 0; --i) places.push_back({x + i, y + height});
    for (int i = height; i > 0; --i) places.push_back({x, y + i});
    std::string line;
    for (std::size_t i = 0; i < std::min(most, places.size()); ++i)
      line += std::to_string(ids.at(places[i])) + " ";
    return line;
  }
};

const std::string kSquare =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n9 9 9\n4 0 1 2 3\n";

}  // namespace

TEST_CASE("a synthetic surface is evaluated against the truth next to it") {
  const Made made;
  const auto report = evaluate({made.out, made.truth});
  CHECK(report.at("true") == 4);
  CHECK(report.at("found") == 4);
  CHECK(report.at("false") == 0);
  CHECK(report.at("recall") == 1);
  CHECK(report.at("precision") == 1);
  CHECK(report.at("boundary").at("within_tolerance").at("f1") > 0.9);
  CHECK(report.at("spacing") == Approx(0.01).epsilon(0.1));
  CHECK(report.at("true_loops").size() == 4);

  const ProgramResult text = run_bench({"evaluate", made.out, made.truth, "--verbose"});
  CHECK(text.exit_code == 0);
  CHECK_THAT(text.out, StartsWith("found 3 of 3 holes and 1 of 1 outer curve, 0 false\n") &&
                           Contains("\n  found       4\n") && Contains("recall      1.000") &&
                           Contains("tolerance precision") &&
                           Contains("\nFound 4 of 4 true loops. Of 4 loops, 0 are false.\n"));
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
  CHECK(text.out ==
        "found 1 of 2 holes and 0 of 1 outer curve, 1 false\n\n"
        "  hole            perimeter  diameter        centre  points  found by\n"
        "  window               40.0      14.1   9.0 9.0 0.0      40    loop 0\n"
        "  shadow of sofa       24.0      8.49  32.0 7.0 0.0      24    missed\n\n"
        "  outer curve   perimeter  diameter        centre  points  found by\n"
        "  edge of wall        156      62.0  29.5 9.5 0.0     156    missed\n\n"
        "  loops that match none  perimeter  diameter         centre  points  what it is\n"
        "  loop 1                      32.0      11.3  42.0 12.0 0.0      32       false\n");
  const auto report = evaluate({found, truth, "--scan", scan});
  CHECK(report.at("true_loops")[0].at("name") == "window");
  CHECK(report.at("true_loops")[0].at("perimeter") == Approx(40));
  CHECK(report.at("true_loops")[0].at("diameter") == Approx(10 * std::sqrt(2)));
  CHECK(report.at("true_loops")[0].at("kind") == "hole");
  CHECK(report.at("true_loops")[1].at("centre")[0] == Approx(32));
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
  std::string rows;
  for (const int y : {0, 3}) {
    for (int x = 0; x < 20; ++x) rows += std::to_string(x) + " " + std::to_string(y) + " 0\n";
  }
  const std::string scan = folder.write("rows.xyz", rows);  // neighbours at 1, 1, 2 and 2: spacing 1.5
  const std::string truth = folder.write("true.txt", "0 2 4 6 8 9 7 5 3 1\n");
  const std::string found = folder.write("found.txt", "20 22 24 26 28 29 27 25 23 21\n");
  CHECK(evaluate({found, truth, "--scan", scan}).at("found") == 1);
  CHECK(evaluate({found, truth, "--scan", scan, "--tolerance", "1.99"}).at("found") == 0);
}

TEST_CASE("the truth of a mesh is its boundary, without vertices that no face uses") {
  const ScratchFolder folder;
  const std::string mesh = folder.write("square.ply", kSquare);
  const std::string loops = folder.write("found.txt", "0 1 2 3\n4 4 4\n");
  const auto report = evaluate({loops, mesh, "--min-vertices", "4"});
  CHECK(report.at("true") == 1);
  CHECK(report.at("found") == 1);
  CHECK(report.at("false") == 1);
  CHECK(report.at("true_loops")[0].at("vertices") == 4);
  CHECK(report.at("spacing") == Approx((2 + std::sqrt(2)) / 3));
}

TEST_CASE("loops on true loops without a match, and loops around gaps in the points, are counted apart") {
  const ScratchFolder folder;
  const Grid grid(40, 40, {{5, 5, 5}, {20, 5, 5}, {5, 20, 5}, {20, 20, 5}});
  const auto around = [&](int gap, std::size_t most = 24) {
    return grid.around(gap % 2 == 0 ? 4 : 19, gap < 2 ? 4 : 19, 6, 6, most);
  };
  std::string away;
  for (int x = 28; x < 36; ++x) away += std::to_string(grid.ids.at({x, 30})) + " ";
  const std::string scan = folder.write("scan.xyz", grid.rows);
  // Gaps 0 and 1 are holes; in gaps 2 and 3 there is surface.
  const std::string truth = folder.write("true.txt", around(0) + "\n" + around(1) + "\n");
  const std::string found =
      folder.write("found.txt", around(0) + around(1) + "\n" + around(0, 10) + "\n" + around(2) + "\n" +
                                    around(1) + around(3) + "\n" + away + "\n");
  const std::string surface = folder.write(
      "surface.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "-9 15 0\n49 15 0\n49 49 0\n-9 49 0\n4 0 1 2 3\n");
  const auto verdicts = [](const nlohmann::json& report) {
    std::vector<std::string> names;
    for (const auto& match : report.at("loop_matches")) names.push_back(match.at("verdict"));
    return names;
  };
  using Names = std::vector<std::string>;

  const auto without = evaluate({found, truth, "--scan", scan, "--tolerance", "1"});
  CHECK(verdicts(without) == Names{"joined", "parted", "false", "false", "false"});
  CHECK((without.at("joined") == 1 && without.at("parted") == 1 && without.at("unsampled") == 0));
  CHECK((without.at("false") == 3 && without.at("found") == 0 && without.at("missed") == 2));
  CHECK(without.at("surface").is_null());
  CHECK(without.at("loop_matches")[0].at("on_any") == 1);
  CHECK(without.at("loop_matches")[2].at("at_unsampled").is_null());

  const auto with = evaluate({found, truth, "--scan", scan, "--tolerance", "1", "--surface", surface});
  CHECK(verdicts(with) == Names{"joined", "parted", "unsampled", "joined", "false"});
  CHECK((with.at("joined") == 2 && with.at("parted") == 1 && with.at("unsampled") == 1));
  CHECK(with.at("false") == 1);
  CHECK(with.at("precision") == Approx(0.2));
  CHECK(with.at("surface") == surface);
  CHECK(with.at("loop_matches")[2].at("at_unsampled") == 1);
  CHECK(with.at("loop_matches")[3].at("at_unsampled") == 0.5);

  const ProgramResult text = run_bench(
      {"evaluate", found, truth, "--scan", scan, "--tolerance", "1", "--surface", surface, "--verbose"});
  CHECK_THAT(
      text.out,
      Contains("\nFound 0 of 2 true loops. Of 5 loops, 1 is false, 2 joined, 1 parted, 1 unsampled.\n") &&
          Contains("\n  unsampled   1\n"));
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
  const ProgramResult text = run_bench({"evaluate", found, truth, "--scan", scan, "--verbose"});
  CHECK_THAT(text.out, Contains("\n  1 loop follows a step of density, with points on both sides\n") &&
                           Contains("step of density\n") && Contains("\n  step        1\n") &&
                           Contains("Of 3 loops, 1 is false, 1 step.\n"));
  const std::string other = folder.write("other.txt", around(1, 1) + "\n#step 1 900\n");
  check_failure(run_bench({"evaluate", found, other, "--scan", scan}), 1, "other.txt: id 900");
}

TEST_CASE("what cannot be evaluated is refused in one line with exit code 1") {
  const Made made;
  const auto refused = [&](std::vector<std::string> arguments, const std::string& reason) {
    arguments.insert(arguments.begin(), "evaluate");
    check_failure(run_bench(arguments), 1, reason);
  };
  const std::string square = made.folder.write("square.ply", kSquare);
  refused({"missing", made.truth}, "missing: cannot be opened");
  refused({made.folder.path().string(), made.truth}, "loops.ply: cannot be opened");
  refused({made.out, made.scan}, "no element 'face'");
  refused({made.out, made.truth, "--surface", made.scan}, "no element 'face'");
  refused({made.out, square}, "is of a scan of");
  refused({made.out + "/loops.ply", square}, "but the scan has 5 points");
  refused({made.truth, square, "--scan", made.scan}, "no --scan is allowed");
  refused({made.truth, made.folder.write("bad.loops.txt", "1 2 x\n")}, "line 1: 'x' is not a point id");
  made.folder.write("far.ply", test::read_file(made.scan));
  refused({made.truth, made.folder.write("far.loops.txt", "1 2 999999\n")}, "id 999999");
  std::ofstream(made.out + "/holes.json") << "{\"counts\": ";
  refused({made.out, made.truth}, "is not JSON");
  std::ofstream(made.out + "/holes.json") << "{}";
  refused({made.out, made.truth}, "is not a report of lacuna detect");
  std::ofstream(made.out + "/holes.json") << R"({"counts": {"points": 1}, "inputs": [], "loops": []})";
  refused({made.out, made.truth}, "both must be of one run");
}

TEST_CASE("wrong usage of evaluate has exit code 2") {
  check_failure(run_bench({"evaluate"}), 2, "RESULT");
  check_failure(run_bench({"evaluate", "a"}), 2, "TRUTH");
  check_failure(run_bench({"evaluate", "a", "b", "--tolerance", "-1"}), 2, "--tolerance");
  check_failure(run_bench({"evaluate", "a", "b", "--min-vertices", "-1"}), 2, "--min-vertices");
}

}  // namespace lacuna
