// SPDX-License-Identifier: Apache-2.0
// `lacuna-bench make` and `lacuna-bench score` as the author of another program calls them.
#include "tests/support/drawn_files.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

// A plane with three holes and a sphere without any, and a folder for the answers of a program.
struct Clouds {
  ScratchFolder folder;
  std::string clouds = (folder / "clouds").string(), results = (folder / "results").string();

  Clouds() {
    fs::create_directories(clouds);
    fs::create_directories(results);
    synth("surface-plane", {"--points", "5000", "--holes", "3", "--hole-radius", "5", "7"});
    synth("closed-sphere", {"--kind", "sphere", "--points", "3000", "--holes", "0"});
  }
  void synth(const std::string& name, const Words& options) const {
    test::synth("surface", clouds + "/" + name + ".ply", options);
  }
  std::string truth(const std::string& name) const { return read_file(clouds + "/" + name + ".loops.txt"); }
  void answer(const std::string& name, const std::string& loops) const {
    folder.write("results/" + name + ".txt", loops);
  }
  std::string score(const Words& options = {}) const {
    return succeed(with({"score", clouds, results}, options), Program::kBench).out;
  }
};

// The cells of a row, divided by one blank.
std::string row(const std::string& text, const std::string& table, const std::string& name) {
  std::istringstream lines(text.substr(std::min(text.size(), text.find("  " + table))));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string cells, word;
    while (words >> word) cells += (cells.empty() ? "" : " ") + word;
    if (cells.starts_with(name + " ")) return cells;
  }
  return "";
}

}  // namespace

TEST_CASE("the true loops score 1, and only kinds with a cloud have a row") {
  const Clouds made;
  for (const char* name : {"surface-plane", "closed-sphere"}) made.answer(name, made.truth(name));
  const std::string text = made.score();
  CHECK(row(text, "per hole", "surface") == "surface 1 3 of 3 1 of 1 0 0");
  CHECK(row(text, "per hole", "closed") == "closed 1 0 of 0 0 of 0 0 0");
  CHECK(row(text, "per hole", "noise").empty());
  CHECK(row(text, "per hole", "all") == "all 2 3 of 3 1 of 1 0 0");
  CHECK(row(text, "per area", "surface") == "surface 1.000 1.000");
  CHECK(row(text, "per point", "all") == "all 1.000 1.000 1.000 1.000 1.000 1.000");
}

TEST_CASE("a true loop that is found twice is found once, and the second loop is false") {
  const Clouds made;
  const std::string truth = made.truth("surface-plane");
  made.answer("surface-plane", truth + truth + truth);
  made.answer("closed-sphere", "");
  const std::string text = made.score();
  CHECK(row(text, "per hole", "surface") == "surface 1 3 of 3 1 of 1 8 0");
  CHECK(row(text, "per area", "surface") == "surface 1.000 0.333");
  const auto all = json_of(made.score({"--json"})).at("all");
  CHECK(all.at("false") == 8);
  CHECK(all.at("repeated") == 8);
  CHECK(json_of(made.score({"--json"})).at("without_result").empty());  // an empty answer is one
}

TEST_CASE("the JSON of a score has every number of the tables, by group and in all") {
  const Clouds made;
  made.answer("surface-plane", made.truth("surface-plane"));
  const auto root = json_of(made.score({"--json"}));
  CHECK(root.at("clouds") == made.clouds);
  CHECK(root.at("tolerance") == 2);
  CHECK(root.at("without_result").dump() == R"(["closed-sphere"])");
  CHECK(root.at("groups").size() == 2);
  CHECK(root.at("groups").at("closed").at("holes").at("true") == 0);
  CHECK(root.at("groups").at("closed").at("areas").at("correctness").is_null());
  const auto& all = root.at("all");
  CHECK(all.at("clouds") == 2);
  CHECK(all.at("holes") == nlohmann::json{{"true", 3}, {"found", 3}});
  CHECK(all.at("outer_curves") == nlohmann::json{{"true", 1}, {"found", 1}});
  CHECK(all.at("joined_or_parted") == 0);
  CHECK(all.at("areas").at("true") > 100);
  CHECK(all.at("areas").at("completeness") == 1);
  CHECK(all.at("points").at("flagged") == all.at("points").at("true"));
  for (const char* kind : {"all", "median"}) CHECK(all.at("points").at(kind).at("f1") == 1);
  CHECK(json_of(made.score({"--json", "--each"})).at("groups").contains("surface-plane"));
}

TEST_CASE("one of three holes is a third of the holes, and all of its area is right") {
  const Clouds made;
  const std::string truth = made.truth("surface-plane");
  const std::size_t first = truth.find("# hole\n");
  made.answer("surface-plane", truth.substr(first, truth.find('#', first + 1) - first));
  const std::string text = made.score();
  CHECK_THAT(text, Contains("no loops for 1 of 2 clouds, such as "));
  CHECK(row(text, "per hole", "surface") == "surface 1 1 of 3 0 of 1 0 0");
  const std::string areas = row(text, "per area", "surface");
  CHECK_THAT(areas, Contains("surface 0.") && Contains(" 1.000"));
  CHECK_THAT(row(text, "per point", "surface"), Contains("surface 1.000 0."));
}

TEST_CASE("a loop through random points is false, on a surface and on a closed mesh") {
  const Clouds made;
  made.answer("surface-plane", made.truth("surface-plane"));
  made.answer("closed-sphere", "5 1200 2400 17 900 2100 333 1500\n");
  made.folder.write("clouds/solid-tetrahedron.ply",
                    ply_header(vertices(4) + "element face 4\nproperty list uchar int vertex_indices\n") +
                        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  made.answer("solid-tetrahedron", "0 1 2\n");
  const std::string text = made.score();
  CHECK(row(text, "per hole", "closed") == "closed 1 0 of 0 0 of 0 1 0");
  CHECK(row(text, "per hole", "solid") == "solid 1 0 of 0 0 of 0 1 0");
  CHECK(row(text, "per hole", "all") == "all 3 3 of 3 1 of 1 2 0");
  CHECK(row(text, "per point", "closed") == "closed 0.000 - 0.000 0.000 - 0.000");
}

TEST_CASE("a loop whose points are in no order is refused in one line that names it, and a bow is not") {
  const Clouds made;
  std::istringstream lines(made.truth("surface-plane"));
  std::vector<std::string> loops;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with('#')) loops.push_back(line);
  const auto is_shorter = [](const std::string& a, const std::string& b) { return a.size() < b.size(); };
  std::sort(loops.begin(), loops.end(), is_shorter);
  std::istringstream words(loops.back());  // the outer curve
  std::vector<std::string> ids{std::istream_iterator<std::string>(words), {}};
  const auto line_of = [&] {
    std::string line;
    for (const std::string& id : ids) line += id + " ";
    return line + "\n";
  };
  // Two halves of the curve that are joined wrongly: two long edges.
  std::reverse(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(ids.size() / 2));
  made.answer("surface-plane", loops[0] + "\n" + line_of());
  CHECK(row(made.score(), "per hole", "surface") == "surface 1 1 of 3 1 of 1 0 0");
  std::shuffle(ids.begin(), ids.end(), std::mt19937(1));
  made.answer("surface-plane", loops[0] + "\n" + line_of());
  check_failure(run_bench({"score", made.clouds, made.results}), 1,
                "surface-plane.txt: loop 1 (from 0): its points are not in order along a curve");
}

TEST_CASE("folders without clouds or without any loops are errors of one line") {
  const Clouds made;
  check_failure(run_bench({"score", made.clouds, made.results}), 1, "closed-sphere.txt");
  check_failure(run_bench({"score", made.results, made.results}), 1, "has no cloud");
  check_failure(run_bench({"score", made.clouds + "/none", made.results}), 1, "cannot be read");
  check_failure(run_bench({"score", made.clouds, made.results, "--tolerance", "-1"}), 2, "--tolerance");
  check_failure(run_bench({"make", "nothing", made.results}), 2, "surfaces, scans, all");
}

TEST_CASE("a set has noise and closed surfaces, and its own truth scores all of its holes") {
  const ScratchFolder folder;
  const std::string clouds = (folder / "clouds").string();
  REQUIRE(run_bench({"make", "surfaces", clouds}).exit_code == 0);
  fs::create_directory(folder / "results");
  for (const fs::directory_entry& file : fs::directory_iterator(clouds)) {
    const std::string name = file.path().filename().string();
    if (const std::size_t end = name.find(".loops.txt"); end != std::string::npos)
      fs::copy(file.path(), folder / "results" / (name.substr(0, end) + ".txt"));
  }
  const std::string text = run_bench({"score", clouds, (folder / "results").string()}).out;
  CHECK(row(text, "per hole", "noise") == "noise 3 24 of 24 2 of 2 0 0");
  CHECK(row(text, "per hole", "closed") == "closed 3 0 of 0 0 of 0 0 0");
}

TEST_CASE("a set has the bytes of its seed, another seed makes other points, and the line says which") {
  const ScratchFolder folder;
  const auto make = [&](const std::string& name, const Words& options) {
    return run_bench(with({"make", "surfaces", (folder / name).string()}, options)).out;
  };
  CHECK_THAT(make("default", {}), Contains("(seed 1)"));
  CHECK_THAT(make("first", {"--seed", "1"}), Contains("(seed 1)"));
  CHECK_THAT(make("second", {"--seed", "2"}), Contains("(seed 2)"));
  for (const fs::directory_entry& file : fs::directory_iterator(folder / "default")) {
    const fs::path name = file.path().filename();
    const std::string bytes = read_file(file.path());
    INFO(name);
    CHECK((bytes == read_file(folder / "first" / name)));
    if (name.extension() == ".ply") CHECK((bytes != read_file(folder / "second" / name)));
  }
}

}  // namespace lacuna::test
