// SPDX-License-Identifier: Apache-2.0
// The result files do not depend on how a run is cut up.
#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using test::read_file;

struct Files {
  std::string points, boundary, loops, records;
};

Files detect_files(const std::string& scan, const fs::path& out, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {
      "detect",          scan,  "--out",     out.string(),      "--quiet", "--points",
      "--points-format", "ply", "--normals", "--orient-normals"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const test::ProgramResult result = test::run_program(arguments);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  // The records as they stand in the file, byte for byte: from their key to the end.
  const std::string report = read_file(out / "holes.json");
  const std::size_t records = report.find("\"loops\": [");
  REQUIRE(records != std::string::npos);
  CHECK(nlohmann::json::parse(report).at("loops").size() > 3);
  return {read_file(out / "points.ply"), read_file(out / "boundary.ply"), read_file(out / "loops.ply"),
          report.substr(records)};
}

TEST_CASE("points.ply, boundary.ply, loops.ply and the records of holes.json are the same for every tiling") {
  const test::ScratchFolder scratch;
  const std::string surface = (scratch / "surface.ply").string(), room = (scratch / "room.ply").string();
  REQUIRE(test::run_bench({"synth", "surface", surface, "--points", "12000", "--holes", "4", "--hole-radius",
                           "3", "6", "--density-step", "4", "--noise", "0.05", "--order", "random"})
              .exit_code == 0);
  REQUIRE(test::run_bench({"synth", "scan", room, "--points", "15000", "--seed", "5"}).exit_code == 0);
  for (const std::string& scan : {surface, room}) {
    const Files one = detect_files(scan, scratch / "one", {"--tile-points", "1000000", "--threads", "1"});
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--tile-points", "500", "--threads", "8"},
          {"--tile-points", "500", "--threads", "1", "--memory-limit", "64MiB"},
          {"--tile-points", "5000", "--threads", "2", "--memory-limit", "64MiB"},
          {"--tile-points", "1000000", "--threads", "8"},
          {}}) {
      const Files files = detect_files(scan, scratch / "other", more);
      INFO(Catch::StringMaker<std::vector<std::string>>::convert(more));
      CHECK((files.points == one.points));
      CHECK((files.boundary == one.boundary));
      CHECK((files.loops == one.loops));
      CHECK((files.records == one.records));
    }
  }
}

}  // namespace
}  // namespace lacuna
