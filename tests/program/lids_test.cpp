// SPDX-License-Identifier: Apache-2.0
// Lids as PLY: read back here, and compared with holes.json of the same run.
#include "bench/evaluation/loops_reader.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

using nlohmann::json;

// Writes a sheet with four holes at coordinates as of UTM, with all digits of a double.
std::string write_earth_sheet(const ScratchFolder& scratch) {
  const std::string surface =
      synth("surface", scratch / "surface.ply",
            {"--points", "12000", "--holes", "4", "--hole-radius", "3", "6", "--order", "random"});
  Cloud cloud;
  for (const auto& row : read_table(surface).rows) cloud.positions.emplace_back(row[0], row[1], row[2]);
  return scratch.write("earth.txt", cloud.translated({500'000.1, 5'400'000.1, 0}).text());
}

// The fields of each line, by the names of the first one.
std::vector<std::map<std::string, std::string>> read_csv(const fs::path& file) {
  const auto fields = [](const std::string& line) {
    std::istringstream text(line + ",");
    Words words;
    for (std::string field; std::getline(text, field, ',');) words.push_back(field);
    return words;
  };
  std::istringstream lines(read_file(file));
  std::string line;
  std::getline(lines, line);
  const Words names = fields(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const Words words = fields(line);
    REQUIRE(words.size() == names.size());
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = words[i];
  }
  return rows;
}

std::vector<Eigen::Vector3d> coordinates(const json& loop) {
  std::vector<Eigen::Vector3d> places;
  for (const json& place : loop.at("coordinates")) places.emplace_back(place[0], place[1], place[2]);
  return places;
}

}  // namespace

TEST_CASE("each hole has its lid between the points of its loop, with all digits on Earth", "[results]") {
  const ScratchFolder scratch;
  const std::string scan = write_earth_sheet(scratch);
  const fs::path out = detect(scan, scratch / "out", {"--lids"});
  const json loops = read_json(out / "holes.json").at("loops");
  const Table ply = read_table(out / "lids.ply");
  CHECK(ply.names == Words{"x", "y", "z", "scalar_loop"});
  std::map<std::size_t, double> areas;
  for (const auto& [a, b, c] : evaluation::read_triangles(out / "lids.ply")) {
    const auto at = [&](std::uint64_t i) { return Eigen::Vector3d(ply.rows.at(i).data()); };
    CHECK(ply.rows[a][3] == ply.rows[b][3]);
    areas[static_cast<std::size_t>(ply.rows[a][3])] += (at(b) - at(a)).cross(at(c) - at(a)).norm() / 2;
  }
  CHECK(areas.size() == 4);
  std::size_t next = 0;
  for (std::size_t id = 0; id < loops.size(); ++id) {
    if (loops[id].at("kind") != "hole") continue;
    for (const Eigen::Vector3d& place : coordinates(loops[id])) {
      CHECK(Eigen::Vector3d(ply.rows.at(next).data()) == place);
      CHECK(ply.rows[next++][3] == static_cast<double>(id));
    }
  }
  CHECK(next == ply.rows.size());
  for (const auto& row : read_csv(out / "holes.csv")) {
    const std::size_t id = std::stoul(row.at("id"));
    CHECK(row.at("lid_area").empty() == (loops[id].at("kind") == "outer"));
    if (row.at("lid_area").empty()) continue;
    CHECK(std::stod(row.at("lid_area")) == Approx(areas.at(id)).epsilon(1e-6));
    CHECK(areas.at(id) == Approx(loops[id].at("area").get<double>()).epsilon(0.1));
  }
  // meshio 5 reads no faces with more.
  CHECK_THAT(read_file(out / "lids.ply"), Contains("property list uchar int vertex_indices\nend_header"));

  // Relative to the offset that the header states, which the reader adds.
  detect(scan, out, {"--lids", "--local-coordinates"});
  CHECK_THAT(read_file(out / "lids.ply").substr(0, 200), Contains("\ncomment lacuna offset "));
  const Table local = read_table(out / "lids.ply");
  REQUIRE(local.rows.size() == ply.rows.size());
  for (std::size_t i = 0; i < local.rows.size(); ++i)
    CHECK((Eigen::Vector3d(local.rows[i].data()) - Eigen::Vector3d(ply.rows[i].data())).norm() < 1e-4);
}

TEST_CASE("a scan without holes has empty lids", "[results]") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const fs::path out = detect(scan, scratch / "out", {"--lids"});
  CHECK(evaluation::read_triangles(out / "lids.ply").empty());
}

}  // namespace lacuna::test
