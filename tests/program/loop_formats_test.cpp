// SPDX-License-Identifier: Apache-2.0
// The loops as OBJ: read back here, and compared with holes.json of the same run.
#include "tests/support/earth_sheet.hpp"
#include "tests/support/run_program.hpp"

#include <array>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace lacuna {
using namespace io;

namespace {

namespace fs = std::filesystem;
using test::read_file;
using Point = std::array<double, 3>;

const std::vector<std::string> kMeasures{"points",     "confidence",      "emptiness", "first_scale",
                                         "last_scale", "perimeter",       "area",      "diameter",
                                         "planarity",  "mean_probability"};

// What holes.json and OBJ say of a loop.
struct ReadLoop {
  std::string kind;
  std::map<std::string, double> measures;
  std::vector<Point> points;
};

bool operator==(const ReadLoop& a, const ReadLoop& b) {
  return a.kind == b.kind && a.measures == b.measures && a.points == b.points;
}

// A sheet with holes at coordinates as of UTM, with all digits of a double; its results are in "out".
nlohmann::json detect_on_earth(const test::ScratchFolder& scratch) {
  const std::string scan = test::write_earth_sheet(scratch);
  test::detect(scan, scratch / "out", {"--obj"});
  return test::read_json(scratch / "out" / "holes.json");
}

std::vector<ReadLoop> loops_of(const nlohmann::json& report) {
  std::vector<ReadLoop> loops;
  for (const auto& record : report.at("loops")) {
    ReadLoop& loop = loops.emplace_back();
    loop.kind = record.at("kind");
    for (const std::string& name : kMeasures) loop.measures[name] = record.at(name);
    if (!record.at("parent").is_null()) loop.measures["parent"] = record.at("parent");
    loop.points = record.at("coordinates").get<std::vector<Point>>();
  }
  return loops;
}

std::vector<ReadLoop> read_obj(const std::string& file) {
  std::vector<ReadLoop> loops;
  std::vector<Point> vertices;
  std::map<std::string, double> comments;
  std::vector<std::array<std::size_t, 2>> edges;
  std::istringstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key, name;
    words >> key;
    if (key == "#") {
      double value = 0;
      if (words >> name >> value) comments[name] = value;
    } else if (key == "v") {
      Point& point = vertices.emplace_back();
      words >> point[0] >> point[1] >> point[2];
    } else if (key == "o") {
      words >> name;
      const auto end = name.find('_');
      CHECK(name.substr(end + 1) == std::to_string(loops.size()));
      loops.push_back({name.substr(0, end), std::exchange(comments, {}), {}});
    } else if (key == "l") {
      // One edge a line: some programs read only the first edge of a longer one.
      std::array<std::size_t, 2>& edge = edges.emplace_back();
      words >> edge[0] >> edge[1];
      CHECK_FALSE(words >> name);
      loops.back().points.push_back(vertices.at(edge[0] - 1));
    }
  }
  std::size_t next = 0;
  for (const ReadLoop& loop : loops) {
    const std::size_t first = next;
    for (; next < first + loop.points.size(); ++next) {
      const std::size_t end = next + 1 < first + loop.points.size() ? next + 1 : first;
      CHECK(edges[next] == std::array{next + 1, end + 1});
    }
  }
  return loops;
}

}  // namespace

TEST_CASE("OBJ has the loops and measures of holes.json, with all digits on Earth", "[results]") {
  const test::ScratchFolder scratch;
  const std::vector<ReadLoop> loops = loops_of(detect_on_earth(scratch));
  REQUIRE(loops.size() == 5);
  REQUIRE(loops[0].points[0][1] > 5e6);
  CHECK(read_obj(read_file(scratch / "out" / "loops.obj")) == loops);
}

TEST_CASE("a scan without loops has an empty OBJ", "[results]") {
  const test::ScratchFolder scratch;
  const std::string scan = scratch.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const fs::path out = scratch / "out";
  test::detect(scan, out, {"--obj"});
  CHECK(read_obj(read_file(out / "loops.obj")).empty());
}

}  // namespace lacuna
