// SPDX-License-Identifier: Apache-2.0
// The loops as OBJ, DXF and VTP: read back here, and compared with holes.json of the same run.
#include "tests/io/io_support.hpp"
#include "tests/support/earth_sheet.hpp"
#include "tests/support/run_program.hpp"

#include <cstring>
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
using test::run_program;
using Point = std::array<double, 3>;

const std::vector<std::string> kMeasures{"points",     "confidence",      "persistence", "first_scale",
                                         "last_scale", "perimeter",       "area",        "diameter",
                                         "planarity",  "mean_probability"};

// What holes.json and each of the formats say of a loop.
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
  REQUIRE(
      run_program({"detect", scan, "--out", (scratch / "out").string(), "--obj", "--dxf", "--vtp", "--quiet"})
          .exit_code == 0);
  return test::read_json(scratch / "out" / "holes.json");
}

std::vector<ReadLoop> loops_of(const nlohmann::json& report) {
  std::vector<ReadLoop> loops;
  for (const auto& record : report.at("loops")) {
    ReadLoop& loop = loops.emplace_back();
    loop.kind = record.at("kind");
    for (const std::string& name : kMeasures) loop.measures[name] = record.at(name);
    loop.points = record.at("coordinates").get<std::vector<Point>>();
  }
  return loops;
}

std::vector<ReadLoop> read_obj(const std::string& file) {
  std::vector<ReadLoop> loops;
  std::vector<Point> vertices;
  std::map<std::string, double> comments;
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
      std::vector<std::size_t> indices;
      for (std::size_t index = 0; words >> index;) indices.push_back(index);
      REQUIRE(indices.size() > 3);
      CHECK(indices.front() == indices.back());
      indices.pop_back();
      for (const std::size_t index : indices) loops.back().points.push_back(vertices.at(index - 1));
    }
  }
  return loops;
}

std::vector<ReadLoop> read_dxf(const std::string& file) {
  std::vector<ReadLoop> loops;
  std::istringstream lines(file);
  std::string code, value, entity, measure;
  bool is_entity = false;
  while (std::getline(lines, code) && std::getline(lines, value)) {
    const int group = std::stoi(code);
    if (group == 2 && value == "ENTITIES") is_entity = true;
    if (!is_entity) continue;
    if (group == 0) {
      entity = value;
      if (entity == "POLYLINE") loops.emplace_back();
      if (entity == "VERTEX") loops.back().points.emplace_back();
    }
    if (entity == "VERTEX" && group >= 10 && group <= 30)
      loops.back().points.back().at(static_cast<std::size_t>(group / 10 - 1)) = std::stod(value);
    if (entity != "POLYLINE") continue;
    if (group == 70) CHECK(value == "9");
    if (group == 8) loops.back().kind = value == "holes" ? "hole" : value == "outer_curves" ? "outer" : value;
    if (group == 1000) measure = value;
    if (group == 1040 || (group == 1071 && measure != "id"))
      loops.back().measures[measure] = std::stod(value);
  }
  CHECK(file.ends_with("0\nENDSEC\n0\nEOF\n"));
  return loops;
}

// The bytes of an array that the file declares with these words, as numbers.
template <class T>
std::vector<T> array_of(const std::string& file, const std::string& section, const std::string& name) {
  const auto begin = file.find("<" + section + ">");
  REQUIRE(begin != std::string::npos);
  const auto declared = file.find("Name=\"" + name + "\"", begin);
  REQUIRE(declared < file.find("</" + section + ">"));
  const auto offset = file.find("offset=\"", declared) + 8;
  const std::string data_mark = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t place = file.find(data_mark) + data_mark.size() + std::stoull(file.substr(offset, 20));
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, file.data() + place, sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  REQUIRE(place + sizeof bytes + bytes <= file.size());
  if (!values.empty()) std::memcpy(values.data(), file.data() + place + sizeof bytes, bytes);
  return values;
}

std::vector<ReadLoop> read_vtp(const std::string& file) {
  const auto coordinates = array_of<double>(file, "Points", "Points");
  const auto connectivity = array_of<std::int64_t>(file, "Lines", "connectivity");
  const auto ends = array_of<std::int64_t>(file, "Lines", "offsets");
  const auto kinds = array_of<std::int64_t>(file, "CellData", "kind");
  std::vector<ReadLoop> loops(ends.size());
  for (std::size_t i = 0, at = 0; i < loops.size(); ++i) {
    loops[i].kind = kinds.at(i) == 0 ? "hole" : "outer";
    const auto end = static_cast<std::size_t>(ends[i]);
    CHECK(connectivity.at(at) == connectivity.at(end - 1));
    for (; at + 1 < end; ++at) {
      const auto vertex = static_cast<std::size_t>(connectivity.at(at));
      loops[i].points.push_back(
          {coordinates.at(3 * vertex), coordinates.at(3 * vertex + 1), coordinates.at(3 * vertex + 2)});
    }
    at = end;
    for (const std::string& name : kMeasures) {
      loops[i].measures[name] =
          name == "points" ? static_cast<double>(array_of<std::int64_t>(file, "CellData", name).at(i))
                           : array_of<double>(file, "CellData", name).at(i);
    }
  }
  return loops;
}

}  // namespace

TEST_CASE("OBJ, DXF and VTP have the loops and measures of holes.json, with all digits on Earth",
          "[results]") {
  const test::ScratchFolder scratch;
  const nlohmann::json report = detect_on_earth(scratch);
  const std::vector<ReadLoop> loops = loops_of(report);
  REQUIRE(loops.size() == 5);
  REQUIRE(loops[0].points[0][1] > 5e6);
  const fs::path out = scratch / "out";
  CHECK(read_obj(read_file(out / "loops.obj")) == loops);
  CHECK(read_dxf(read_file(out / "loops.dxf")) == loops);
  const std::string vtp = read_file(out / "loops.vtp");
  CHECK(read_vtp(vtp) == loops);
  std::vector<std::int64_t> ids;
  for (const auto& record : report.at("loops"))
    for (const auto& id : record.at("ids")) ids.push_back(id);
  CHECK(array_of<std::int64_t>(vtp, "PointData", "id") == ids);
  CHECK(array_of<std::int64_t>(vtp, "CellData", "id") == std::vector<std::int64_t>{0, 1, 2, 3, 4});
  for (const float probability : array_of<float>(vtp, "PointData", "probability")) {
    CHECK(probability > 0);
    CHECK(probability <= 1);
  }
}

TEST_CASE("a scan without loops has an empty OBJ, DXF and VTP, and a later run without them removes them",
          "[results]") {
  const test::ScratchFolder scratch;
  const std::string scan = scratch.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const fs::path out = scratch / "out";
  const std::vector<std::string> run{"detect", scan, "--out", out.string(), "--quiet"};
  std::vector<std::string> with_all = run;
  for (const char* flag : {"--obj", "--dxf", "--vtp"}) with_all.emplace_back(flag);
  for (int i = 0; i < 2; ++i) {  // the second one replaces those of the first
    REQUIRE(run_program(with_all).exit_code == 0);
    CHECK(read_obj(read_file(out / "loops.obj")).empty());
    CHECK(read_dxf(read_file(out / "loops.dxf")).empty());
    CHECK(read_vtp(read_file(out / "loops.vtp")).empty());
  }
  REQUIRE(run_program(run).exit_code == 0);
  for (const char* name : {"loops.obj", "loops.dxf", "loops.vtp"}) CHECK_FALSE(fs::exists(out / name));
}

TEST_CASE("a loops.obj, .dxf or .vtp that Lacuna did not write is refused", "[results]") {
  const test::ScratchFolder scratch;
  const std::string scan = scratch.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  for (const std::string format : {"obj", "dxf", "vtp"}) {
    const fs::path mine = scratch.write("loops." + format, "# another program\nv 0 0 0\n");
    const auto refused =
        run_program({"detect", scan, "--out", scratch.path().string(), "--" + format, "--quiet"});
    CHECK(refused.exit_code == 1);
    CHECK_THAT(refused.err,
               Catch::Contains("loops." + format + ": exists, and this command did not write it"));
    CHECK(read_file(mine) == "# another program\nv 0 0 0\n");
    fs::remove(mine);
  }
}

}  // namespace lacuna
