// SPDX-License-Identifier: Apache-2.0
// The files of lids: read back here, and compared with each other and with holes.json of the same run.
#include "bench/evaluation/mesh_reader.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/earth_sheet.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using test::read_file;
using test::write_earth_sheet;
using Strings = std::vector<std::string>;

struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint64_t, 3>> triangles;  // count vertices from 0
  std::vector<std::uint64_t> loops;                     // of each triangle
};

Mesh read_obj(const fs::path& file) {
  Mesh mesh;
  std::istringstream lines(read_file(file));
  std::uint64_t loop = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key, name;
    words >> key;
    if (key == "v") {
      Eigen::Vector3d& vertex = mesh.vertices.emplace_back();
      words >> vertex.x() >> vertex.y() >> vertex.z();
    } else if (key == "o") {
      words >> name;
      REQUIRE(name.starts_with("hole_"));
      loop = std::stoull(name.substr(5));
    } else if (key == "f") {
      auto& triangle = mesh.triangles.emplace_back();
      for (std::uint64_t& corner : triangle) {
        words >> corner;
        --corner;
      }
      mesh.loops.push_back(loop);
    }
  }
  return mesh;
}

std::map<std::uint64_t, double> areas(const Mesh& mesh) {
  std::map<std::uint64_t, double> areas;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d& at = mesh.vertices.at(a);
    areas[mesh.loops[t]] += (mesh.vertices.at(b) - at).cross(mesh.vertices.at(c) - at).norm() / 2;
  }
  return areas;
}

struct Row {
  std::uint64_t loop, triangles;
  std::string area, reason;
};

std::vector<Row> read_csv(const fs::path& file) {
  std::istringstream lines(read_file(file));
  std::string line;
  std::getline(lines, line);
  CHECK(line == "loop,triangles,lid_area,reason");
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    std::array<std::string, 4> fields;
    std::istringstream text(line);
    for (std::string& field : fields) std::getline(text, field, ',');
    rows.push_back({std::stoull(fields[0]), std::stoull(fields[1]), fields[2], fields[3]});
  }
  return rows;
}

}  // namespace

TEST_CASE("each hole has its lid in OBJ, PLY and CSV, with all digits on Earth, and outer curves have none",
          "[results]") {
  const test::ScratchFolder scratch;
  const fs::path out = test::detect(write_earth_sheet(scratch), scratch / "out", {"--lids"});
  const nlohmann::json loops = test::read_json(out / "holes.json").at("loops");
  const Mesh obj = read_obj(out / "lids.obj");
  const std::map<std::uint64_t, double> area = areas(obj);
  const std::vector<Row> rows = read_csv(out / "lids.csv");

  std::size_t at = 0, first = 0, lids = 0;
  for (std::size_t id = 0; id < loops.size(); ++id) {
    if (loops[id].at("kind") != "hole") {
      CHECK(area.count(id) == 0);
      continue;
    }
    REQUIRE(at < rows.size());
    const Row& row = rows[at++];
    CHECK(row.loop == id);
    CHECK(row.reason.empty());
    CHECK(row.triangles == static_cast<std::uint64_t>(std::count(obj.loops.begin(), obj.loops.end(), id)));
    CHECK(std::stod(row.area) == Approx(area.at(id)).epsilon(1e-6));
    CHECK(std::stod(row.area) == Approx(loops[id].at("area").get<double>()).epsilon(0.1));  // it is flat
    const auto coordinates = loops[id].at("coordinates").get<std::vector<std::array<double, 3>>>();
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      CHECK(obj.vertices.at(first + i) == Eigen::Map<const Eigen::Vector3d>(coordinates[i].data()));
    const auto corners = std::count(obj.loops.begin(), obj.loops.end(), id) + 2;  // by Euler's formula
    first += (static_cast<std::size_t>(corners) + coordinates.size()) / 2;
    ++lids;
  }
  CHECK(lids == 4);
  CHECK(at == rows.size());
  CHECK(first == obj.vertices.size());

  const test::Table ply = test::read_table(out / "lids.ply");
  CHECK(ply.names == Strings{"x", "y", "z", "scalar_loop"});
  REQUIRE(ply.rows.size() == obj.vertices.size());
  for (std::size_t i = 0; i < ply.rows.size(); ++i)
    CHECK(Eigen::Map<const Eigen::Vector3d>(ply.rows[i].data()) == obj.vertices[i]);
  CHECK(evaluation::read_triangles(out / "lids.ply") == obj.triangles);
  for (std::size_t t = 0; t < obj.triangles.size(); ++t) {
    for (const std::uint64_t corner : obj.triangles[t])
      CHECK(ply.rows[corner][3] == static_cast<double>(obj.loops[t]));
  }
  // meshio 5 reads no faces with more than their list.
  CHECK(read_file(out / "lids.ply").find("property list uchar int vertex_indices\nend_header") !=
        std::string::npos);
}

TEST_CASE("lids of local coordinates are relative to the offset that the header states", "[results]") {
  const test::ScratchFolder scratch;
  const fs::path out =
      test::detect(write_earth_sheet(scratch), scratch / "out", {"--lids", "--local-coordinates"});
  const std::string ply = read_file(out / "lids.ply");
  CHECK(ply.find("\ncomment lacuna offset ") < ply.find("end_header"));
  const Mesh obj = read_obj(out / "lids.obj");
  const test::Table read = test::read_table(out / "lids.ply");  // adds the offset
  REQUIRE(read.rows.size() == obj.vertices.size());
  for (std::size_t i = 0; i < read.rows.size(); ++i)
    CHECK((Eigen::Map<const Eigen::Vector3d>(read.rows[i].data()) - obj.vertices[i]).norm() < 1e-4);
}

TEST_CASE("a scan without holes has empty lids", "[results]") {
  const test::ScratchFolder scratch;
  const std::string scan = scratch.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const fs::path out = scratch / "out";
  test::detect(scan, out, {"--lids"});
  CHECK(read_obj(out / "lids.obj").triangles.empty());
  CHECK(evaluation::read_triangles(out / "lids.ply").empty());
  CHECK(read_csv(out / "lids.csv").empty());
}

}  // namespace lacuna
