// SPDX-License-Identifier: Apache-2.0
// The files of a run as other programs read them: for every tiling, in local coordinates, of chosen points,
// and the sample.
#include "engine/pipeline.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

// Every kind of result that needs no GDAL, but for the page: it shows the parameters.
const Words kAllResults = {"--points",         "--points-format", "ply", "--points-normals", "--lids",
                           "--orient-normals", "--sample-points", "3000"};

void check_every_tiling(const std::string& scan, const fs::path& folder, const Words& options) {
  const auto detect = [&](const std::string& out, const Words& more) {
    return test::detect(scan, folder / out, with(with(kAllResults, options), more));
  };
  const fs::path one = detect("one", {"--tile-points", "1000000", "--threads", "1"});
  CHECK(read_json(one / "holes.json").at("loops").size() > 3);
  for (const char* name : {"points.ply", "lids.ply"}) CHECK(fs::exists(one / name));
  for (const Words& more : {Words{"--tile-points", "500", "--threads", "8", "--memory-limit", "64MiB"},
                            {"--tile-points", "5000", "--threads", "2"},
                            {}}) {
    INFO(Catch::StringMaker<Words>::convert(more));
    check_same_results(detect("other", more), one);
  }
}

TEST_CASE("all results of a surface on Earth, with local coordinates, are the same for every tiling") {
  const ScratchFolder scratch;
  const std::string scan =
      synth("surface", scratch / "surface.ply",
            {"--points", "12000", "--holes", "4", "--hole-radius", "3", "6", "--density-step", "4", "--noise",
             "0.05", "--order", "random", "--double", "--translate", "500000.1", "5400000.7", "300.3"});
  check_every_tiling(scan, scratch.path(), {"--local-coordinates"});
}

TEST_CASE("all results of a scan with stations, and their causes, are the same for every tiling") {
  const ScratchFolder scratch;
  const std::string scan = synth("scan", scratch / "room.ply", {"--points", "15000", "--seed", "5"});
  check_every_tiling(scan, scratch.path(), {"--stations", (scratch / "room.stations.txt").string()});
}

}  // namespace

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

namespace {

using nlohmann::json;

std::string rows_of(const Cloud& cloud, int classification) {
  std::string rows = cloud.text();
  for (std::size_t at = 0; (at = rows.find('\n', at)) != rows.npos; at += 3)
    rows.insert(at, " " + std::to_string(classification));
  return rows;
}

TEST_CASE("scans in their own coordinates with poses, and filters, give the loops of the chosen points") {
  const ScratchFolder scratch;
  const Cloud left = plane(30).punched({14, 14}, 4).translated({0, 0, 1});
  const Cloud right = plane(30).punched({20, 9}, 3).translated({30, 0, 1});
  const std::string header = "x y z Classification\n";
  const auto whole = scratch.write("whole.csv", header + rows_of(left, 2) + rows_of(right, 2));
  const json expected = read_json(detect(whole, scratch / "whole") / "holes.json");
  REQUIRE(expected["counts"]["holes"] == 2);

  // The right part has its origin elsewhere; points of class 7 fill its hole, points at 0 0 0 have no return.
  scratch.write("left.csv", header + rows_of(left, 2));
  scratch.write("right.csv", header + rows_of(right.translated({-512, 1024, 0}), 2) +
                                 rows_of(plane(8).translated({30 - 512 + 17, 1024 + 6, 1}), 7) +
                                 "0 0 0 2\n0 0 0 2\n");
  const auto list = scratch.write("list.txt", "left.csv\nright.csv pose=512 -1024 0 0 0 0 1\n");
  const json found =
      read_json(detect("@" + list, scratch / "posed",
                       {"--where", "Classification == 2 or z > 100", "--drop-origin", "--keep-noise"}) /
                "holes.json");
  CHECK(found["loops"] == expected["loops"]);
  CHECK(found["counts"]["filtered_out"]["where"] == 64);
  CHECK(found["counts"]["filtered_out"]["origin"] == 2);
  CHECK(found["counts"]["dropped"] == 0);
  CHECK(found["inputs"][1]["pose"] == json({1, 0, 0, 512, 0, 1, 0, -1024, 0, 0, 1, 0, 0, 0, 0, 1}));
}

}  // namespace

namespace {

std::string text_of(const Cloud& cloud) {
  std::ostringstream text;
  text.precision(17);
  text << "x y z red green blue\n";
  for (std::size_t i = 0; i < cloud.size(); ++i)
    text << cloud.positions[i].transpose() << " " << i % 256 << " " << i / 256 % 256 << " 7\n";
  return text.str();
}

struct Runs {
  explicit Runs(const Cloud& cloud) : scan(scratch.write("scan.txt", text_of(cloud))) {}

  fs::path detect(const Words& options) const {
    return test::detect(scan, scratch / "out", with(options, {"--every-point"}));
  }

  ScratchFolder scratch;
  std::string scan;
};

double cell_at(const Table& table, std::size_t row, const std::string& name) {
  return table.rows[row][table.place(name)];
}

// Keys are counted by bins: any number may be the end of one.
TEST_CASE("a sample has as many points as are wanted, whatever the number, and cell_at most all") {
  const Cloud cloud = plane(20).jittered(0.3, 1);
  const auto sampled = [&](std::int64_t wanted, std::int64_t tile_points) {
    Config config = tiled({}, tile_points);
    config.scale.every_point = true;
    config.results.sample_points = wanted;
    MemoryScan scan(cloud);
    NoProgress quiet;
    const ScratchFolder temporary;
    return detect(scan, config, temporary.path(), quiet)->sampled_points;
  };
  for (std::int64_t wanted = 0; wanted < 400; wanted += wanted < 12 ? 1 : 29) {
    INFO(wanted);
    CHECK(sampled(wanted, 100) == static_cast<std::uint64_t>(wanted));
  }
  for (const std::int64_t wanted : {399, 400, 900})
    CHECK(sampled(wanted, 0) == static_cast<std::uint64_t>(std::min<std::int64_t>(wanted, 400)));
  CHECK_FALSE(fs::exists(Runs(cloud).detect({"--sample-points", "0"}) / "sample.ply"));
}

TEST_CASE("the sample has points of the scan in ascending id, with their probabilities and colours") {
  Runs runs(plane(80).punched({40, 40}, 9).jittered(0.3, 1).shuffled(2));
  const fs::path out = runs.detect({"--points", "--points-format", "ply", "--sample-points", "1500"});
  const Table sample = read_table(out / "sample.ply"), points = read_table(out / "points.ply");
  REQUIRE(sample.rows.size() == 1500);
  double last = -1;
  for (std::size_t i = 0; i < sample.rows.size(); ++i) {
    const double id = cell_at(sample, i, "scalar_id");
    CHECK(id > last);
    last = id;
    const auto row = static_cast<std::size_t>(id);
    for (const char* const name : {"x", "y", "z", "scalar_probability", "red", "green", "blue"}) {
      INFO(name);
      CHECK(cell_at(sample, i, name) == cell_at(points, row, name));
    }
    CHECK(std::abs(cell_at(sample, i, "nz")) == Approx(1).margin(1e-6));
  }
}

TEST_CASE("the sample is spread by area, however dense the scan is, and denser near boundaries") {
  // The left half is four times as dense as the right one.
  Runs runs(density_step(160).jittered(0.2, 1));
  const Table sample = read_table(runs.detect({"--sample-points", "2000"}) / "sample.ply");
  std::map<std::string, double> counts;
  for (std::size_t i = 0; i < sample.rows.size(); ++i) {
    const double x = cell_at(sample, i, "x"), y = cell_at(sample, i, "y");
    const bool is_inside = y > 20 && y < 140;
    if (is_inside && x > 20 && x < 70) ++counts["left"];
    if (is_inside && x > 90 && x < 140) ++counts["right"];
    if (is_inside && x < 2) ++counts["edge"];
  }
  CHECK(counts["left"] == Approx(counts["right"]).epsilon(0.25));
  CHECK(counts["edge"] / 2 > 1.8 * counts["left"] / 50);
}

}  // namespace

}  // namespace lacuna::test
