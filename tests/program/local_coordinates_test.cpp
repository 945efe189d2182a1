// SPDX-License-Identifier: Apache-2.0
// Runs with --local-coordinates, and every command that reads their results.
#include "tests/support/clouds.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

using nlohmann::json;

// At UTM. Their coordinates are multiples of 1/1024, so that local floats are exact.
Cloud exact_sheet() {
  const Cloud cloud = plane(60).punched({20, 20}, 6).punched({42, 40}, 4).jittered(0.2, 1);
  return cloud.rounded(1. / 1024).translated({500'000, 5'400'000, 300});
}

// What the page shows, but for the parameters and the times of the run.
json shown(const fs::path& out) {
  json report = json_of(element(read_file(out / "report.html"), "report"));
  for (const char* key : {"changed", "parameters", "run", "title", "inputs"}) report.erase(key);
  return report;
}

TEST_CASE("pages, pictures and evaluations of local coordinates are those of the scan's own") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", exact_sheet().text());
  const fs::path plain = scratch / "plain", local = scratch / "local";
  detect(scan, plain, {"--report", "--points", "--points-format", "ply"});
  detect(scan, local, {"--report", "--points", "--points-format", "ply", "--local-coordinates"});
  CHECK(read_json(local / "holes.json").at("offset") == json{500'030, 5'400'030, 300});
  CHECK(read_json(local / "holes.json").at("loops") == read_json(plain / "holes.json").at("loops"));
  CHECK(read_file(local / "holes.csv") == read_file(plain / "holes.csv"));

  for (const fs::path& out : {plain, local}) {
    fs::copy(out / "report.html", out / "of-detect.html");
    succeed({"report", out.string()});
    CHECK((read_file(out / "report.html") == read_file(out / "of-detect.html")));
    succeed({"render", out.string(), "--out", (out / "top.png").string(), "--size", "400x300"});
    succeed({"render", out.string(), "--out", (out / "low.png").string(), "--size", "400x300", "--hide-above",
             "299"});
  }
  CHECK(shown(local) == shown(plain));
  const std::string local_page = read_file(local / "report.html"), page = read_file(plain / "report.html");
  for (const char* id : {"positions", "probabilities", "normals", "loop_vertices"})
    CHECK((element(local_page, id) == element(page, id)));
  for (const char* picture : {"top.png", "low.png"})
    CHECK((read_file(local / picture) == read_file(plain / picture)));
  CHECK((read_file(local / "top.png") != read_file(local / "low.png")));

  const json holes = read_json(plain / "holes.json");
  std::string truth;
  for (const json& loop : holes.at("loops")) {
    for (const json& id : loop.at("ids")) truth += id.dump() + " ";
    truth += "\n";
  }
  const std::string truth_file = scratch.write("truth.txt", truth);
  const auto evaluated = [&](const std::string& result, const Words& more) {
    const Words words = with({"evaluate", result, truth_file, "--json"}, more);
    json found = json_of(succeed(words, Program::kBench).out);
    found.erase("result");
    return found.dump();
  };
  const std::string expected = evaluated(plain.string(), {});
  CHECK_THAT(expected, Contains("\"found\":3"));
  CHECK(evaluated(local.string(), {}) == expected);
  const std::string points = (local / "points.ply").string();
  CHECK(evaluated((local / "loops.ply").string(), {"--scan", points}) ==
        evaluated((plain / "loops.ply").string(), {"--scan", (plain / "points.ply").string()}));
}

}  // namespace
}  // namespace lacuna::test
