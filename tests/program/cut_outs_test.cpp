// SPDX-License-Identifier: Apache-2.0
// Cut-outs as a user gets them: compared with the scan and with holes.json of the same run.
#include "tests/io/io_support.hpp"
#include "tests/support/earth_sheet.hpp"
#include "tests/support/run_program.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using test::read_file;
using test::read_table;
using test::run_program;
using test::Table;
using Strings = std::vector<std::string>;

void run(Strings words) {
  words.emplace_back("--quiet");
  const auto ended = run_program(words);
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
}

fs::path detect(const std::string& scan, const fs::path& out, const Strings& options) {
  Strings words{"detect", scan, "--out", out.string()};
  words.insert(words.end(), options.begin(), options.end());
  run(words);
  return out;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    files[entry.path().filename()] = read_file(entry.path());
  return files;
}

// Checks that each hole of the run has its file, and no other loop has one.
void check_cut_outs(const fs::path& out, const std::string& scan, const std::string& extension,
                    double margin) {
  const Table all = read_table(scan);
  const nlohmann::json loops = test::read_json(out / "holes.json").at("loops");
  std::size_t holes = 0;
  for (std::size_t id = 0; id < loops.size(); ++id) {
    const fs::path file = out / "cut-outs" / ("hole-" + std::to_string(id) + extension);
    if (loops[id].at("kind") != "hole") {
      CHECK_FALSE(fs::exists(file));
      continue;
    }
    ++holes;
    Eigen::AlignedBox3d box;
    for (const auto& point : loops[id].at("coordinates"))
      box.extend(Eigen::Vector3d(point[0].get<double>(), point[1].get<double>(), point[2].get<double>()));
    box = {box.min().array() - margin, box.max().array() + margin};
    std::vector<std::vector<double>> expected;
    for (const auto& row : all.rows) {
      if (!box.contains(Eigen::Vector3d(row[0], row[1], row[2]))) continue;
      expected.push_back(row);
      if (extension == ".csv") expected.back().push_back(static_cast<double>(id));
    }
    Strings names = all.names;
    if (extension == ".csv") names.emplace_back("lacuna_hole");
    const Table read = read_table(file);
    CHECK(read.names == names);
    CHECK((read.rows == expected));
    CHECK(read.rows.size() > 50);
    CHECK(read.rows.size() < all.rows.size());
  }
  CHECK(holes == 4);
  CHECK(files_of(out / "cut-outs").size() == holes);
}

}  // namespace

TEST_CASE("each hole has the points of the scan around it, with all attributes", "[results]") {
  const test::ScratchFolder scratch;
  const std::string text = test::write_earth_sheet(scratch);
  check_cut_outs(detect(text, scratch / "csv", {"--cut-outs", "0.03"}), text, ".csv", 0.03);
  const fs::path made = detect(text, scratch / "ply", {"--points", "--points-format", "ply"});
  const std::string scan = (made / "points.ply").string();  // has many columns
  check_cut_outs(detect(scan, scratch / "out", {"--cut-outs", "0.2"}), scan, ".ply", 0.2);
}

TEST_CASE("cut-outs are the same for every tiling, number of threads, memory limit and way of a run",
          "[results]") {
  const test::ScratchFolder scratch;
  const std::string text = test::write_earth_sheet(scratch, "40000");
  for (const std::string format : {"csv", "ply"}) {
    const Strings options{"--cut-outs", "0.1", "--points-format", format};
    const auto with = [&](Strings more) {
      more.insert(more.end(), options.begin(), options.end());
      return more;
    };
    const auto plain = files_of(detect(text, scratch / "plain", options) / "cut-outs");
    CHECK(plain.size() == 4);
    const fs::path tiled = detect(
        text, scratch / "tiled", with({"--tile-points", "700", "--threads", "5", "--memory-limit", "64MiB"}));
    CHECK((files_of(tiled / "cut-outs") == plain));
    const std::string workspace = (scratch / ("workspace " + format)).string();
    CHECK((files_of(detect(text, scratch / "kept", with({"--workspace", workspace})) / "cut-outs") == plain));
    CHECK((files_of(detect(text, scratch / "kept", with({"--workspace", workspace})) / "cut-outs") == plain));
  }
}

TEST_CASE("a run names the folder of cut-outs, and a later one without them removes it", "[results]") {
  const test::ScratchFolder scratch;
  const std::string scan = test::write_earth_sheet(scratch);
  const fs::path out = scratch / "out";
  const auto first = run_program({"detect", scan, "--out", out.string(), "--cut-outs", "1"});
  CHECK_THAT(first.out, Catch::Contains("written: " + (out / "cut-outs").string() + "\n"));
  CHECK(files_of(out / "cut-outs").size() == 4);
  const std::string mine = scratch.write("out/cut-outs/hole-3.ply", "ply, but mine\n");
  const auto refused = run_program(
      {"detect", scan, "--out", out.string(), "--cut-outs", "1", "--points-format", "ply", "--quiet"});
  CHECK(refused.exit_code == 1);
  CHECK_THAT(refused.err, Catch::Contains("hole-3.ply: exists, and this command did not write it"));
  CHECK(files_of(out / "cut-outs").size() == 5);
  detect(scan, out, {});
  CHECK(files_of(out / "cut-outs") == std::map<std::string, std::string>{{"hole-3.ply", "ply, but mine\n"}});
  fs::remove(mine);
  detect(scan, out, {"--cut-outs", "1"});
  detect(scan, out, {});
  CHECK_FALSE(fs::exists(out / "cut-outs"));
}

TEST_CASE("a scan without holes has no folder of cut-outs", "[results]") {
  const test::ScratchFolder scratch;
  const std::string scan = scratch.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  CHECK_FALSE(fs::exists(detect(scan, scratch / "out", {"--cut-outs", "1"}) / "cut-outs"));
  const auto refused = run_program({"detect", scan, "--out", "out", "--cut-outs", "2m", "--quiet"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Catch::Contains("a number without a unit"));
}

}  // namespace lacuna
