// SPDX-License-Identifier: Apache-2.0
// Runs with --local-coordinates, and every command that reads their results.
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using nlohmann::json;
using test::read_file;
using test::run_program;
using test::ScratchFolder;
using Strings = std::vector<std::string>;

// At UTM. Their coordinates are multiples of 1/1024, so that local floats are exact.
Cloud exact_sheet() {
  Cloud cloud = plane(60).punched({20, 20}, 6).punched({42, 40}, 4).jittered(0.2, 1);
  for (Eigen::Vector3d& p : cloud.positions) p = (p * 1024).array().round() / 1024;
  return cloud.translated({500'000, 5'400'000, 300});
}

std::string text_of(const Cloud& cloud) {
  std::ostringstream text;
  text.precision(17);
  for (const Eigen::Vector3d& p : cloud.positions) text << p.transpose() << "\n";
  return text.str();
}

void succeed(const Strings& words) {
  const auto run = run_program(words);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
}

void detect(const std::string& scan, const fs::path& out, const Strings& options) {
  Strings words = {"detect", scan, "--out", out.string(), "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  succeed(words);
}

std::string element(const std::string& page, const std::string& id) {
  const std::string begin = "id=\"" + id + "\">";
  const std::size_t at = page.find(begin);
  REQUIRE(at != page.npos);
  return page.substr(at + begin.size(), page.find("</script>", at) - at - begin.size());
}

// What the page shows, but for the parameters and the times of the run.
json shown(const fs::path& out) {
  json report = json::parse(element(read_file(out / "report.html"), "report"));
  for (const char* key : {"changed", "parameters", "run", "title", "inputs"}) report.erase(key);
  return report;
}

TEST_CASE("pages, pictures and evaluations of local coordinates are those of the scan's own") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", text_of(exact_sheet()));
  const fs::path plain = scratch / "plain", local = scratch / "local";
  detect(scan, plain, {"--report", "--points", "--points-format", "ply"});
  detect(scan, local, {"--report", "--points", "--points-format", "ply", "--local-coordinates"});
  CHECK(test::read_json(local / "holes.json").at("offset") == json{500'030, 5'400'030, 300});
  CHECK(test::read_json(local / "holes.json").at("loops") ==
        test::read_json(plain / "holes.json").at("loops"));
  for (const char* name : {"holes.csv"}) CHECK(read_file(local / name) == read_file(plain / name));
  for (const char* name : {"loops.ply", "boundary.ply", "sample.ply", "points.ply"}) {
    INFO(name);
    CHECK_THAT(read_file(local / name).substr(0, 200),
               Contains("lacuna offset 500030 5400030 300\n") && Contains("property float x\n"));
    const test::Table one = test::read_table(local / name), other = test::read_table(plain / name);
    CHECK(one.names == other.names);
    CHECK((one.rows == other.rows));
  }

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

  const json holes = test::read_json(plain / "holes.json");
  std::string truth;
  for (const json& loop : holes.at("loops")) {
    for (const json& id : loop.at("ids")) truth += id.dump() + " ";
    truth += "\n";
  }
  const std::string truth_file = scratch.write("truth.txt", truth);
  const auto evaluated = [&](const std::string& result, const Strings& more) {
    Strings words = {"evaluate", result, truth_file, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = test::run_bench(words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    json found = json::parse(run.out);
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

TEST_CASE("detect and info read local coordinates as those of the scan") {
  const ScratchFolder scratch;
  const Cloud sheet = exact_sheet();
  const std::string scan = scratch.write("scan.txt", text_of(sheet));
  const fs::path out = scratch / "out";
  detect(scan, out, {"--points", "--points-format", "ply", "--local-coordinates"});
  const json expected = test::read_json(out / "holes.json");
  const fs::path file = scratch / "points.ply";
  fs::copy(out / "points.ply", file);
  detect(file.string(), scratch / "again", {"--points"});
  const json again = test::read_json(scratch / "again" / "holes.json");
  for (const char* key : {"loops", "bounds", "strays"}) CHECK(again.at(key) == expected.at(key));
  CHECK(again.at("offset").is_null());
  const test::Table points = test::read_table(scratch / "again" / "points" / "points.ply");
  REQUIRE(points.rows.size() == sheet.size());
  for (std::size_t i = 0; i < sheet.size(); ++i)
    REQUIRE(Eigen::Vector3d(points.rows[i][0], points.rows[i][1], points.rows[i][2]) == sheet.positions[i]);
  CHECK_THAT(run_program({"info", file.string()}).out,
             Contains("bounds        499999.8145 5399999.809 300 to 5000"));
}

TEST_CASE("files with local coordinates are the same for every tiling, and near their scan with strays") {
  const ScratchFolder scratch;
  // The scan touches its bounds with coordinates that no float has.
  const Cloud cloud = plane(80)
                          .punched({30, 30}, 7)
                          .jittered(0.3, 1)
                          .noisy(0.1, 2)
                          .translated({500'000.1, 5'400'000.7, 300.3});
  const Cloud stray{{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1e30, 0, 0)}, {}};
  const std::string scan = scratch.write("scan.txt", text_of(cloud.joined(stray)));
  Strings names = {"points.ply", "loops.ply", "boundary.ply", "sample.ply"};
  const auto files = [&](const Strings& options) {
    std::string bytes;
    Strings words = {"--points", "--points-format", "ply", "--local-coordinates", "--report"};
    words.insert(words.end(), options.begin(), options.end());
    detect(scan, scratch / "out", words);
    for (const std::string& name : names) bytes += read_file(scratch / "out" / name);
    return bytes;
  };
  const std::string one = files({"--threads", "1", "--tile-points", "1000000"});
  CHECK((files({"--threads", "8", "--tile-points", "500"}) == one));
  CHECK((files({"--threads", "2", "--tile-points", "900", "--memory-limit", "96MiB"}) == one));
  const json holes = test::read_json(scratch / "out" / "holes.json");
  CHECK(holes.at("offset") == json{500'040, 5'400'040, 300});
  CHECK(holes.at("strays").at("points") == 2);

  detect(scan, scratch / "plain", {"--report"});
  const json with = shown(scratch / "out"), without = shown(scratch / "plain");
  for (const char* key : {"frame", "bounds", "strays", "loops"}) CHECK(with.at(key) == without.at(key));
  CHECK(with.at("sample").at("points") == without.at("sample").at("points"));
  const test::Table sample = test::read_table(scratch / "out" / "sample.ply"),
                    exact = test::read_table(scratch / "plain" / "sample.ply");
  REQUIRE(sample.rows.size() == exact.rows.size());
  double largest = 0;
  for (std::size_t i = 0; i < sample.rows.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double difference = std::abs(sample.rows[i][axis] - exact.rows[i][axis]);
      if (exact.rows[i][0] > 1e6) continue;  // the stray, which floats keep no better than relatively
      const double local = std::abs(exact.rows[i][axis] - holes.at("offset")[axis].get<double>());
      REQUIRE(difference <= std::ldexp(local, -24) + 1e-9);  // a double's own step at UTM is 1e-9
      largest = std::max(largest, difference);
    }
  }
  CHECK(largest > 0);
}

}  // namespace
}  // namespace lacuna
