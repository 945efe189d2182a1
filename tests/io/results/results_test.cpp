// SPDX-License-Identifier: Apache-2.0
// What a run writes: loops, reports and points; local coordinates; the shares of cells that holes cover.
#include "io/write/results/results.hpp"

#include "io/read/formats.hpp"
#include "io/write/results/gis_results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/json.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {

TEST_CASE("a run without holes leaves an empty loops.ply and a report without loops", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.ply", ascii_ply("1 2 3\n"))}, {});
  const auto out = folder / "new" / "out";
  write_results(FakeDetection().with_results(1), scan, FilesConfig{}, out);
  CHECK(read_table(out / "loops.ply").rows.empty());
  CHECK(read_table(out / "boundary.ply").rows.empty());
  CHECK_FALSE(fs::exists(out / "points.ply"));
  const auto json = read_json(out / "holes.json"), run = read_json(out / "run.json");
  CHECK(json.at("loops").empty());
  CHECK(json.at("bounds").is_null());
  CHECK(read_file(out / "holes.csv") ==
        "id,kind,points,confidence,perimeter,area,diameter,x,y,z,nx,ny,nz,"
        "cause,hidden_by_x,hidden_by_y,hidden_by_z\n");
  CHECK(run.at("points_per_second").is_null());
  CHECK(run.at("peak_memory_bytes") > 0);
  CHECK(json.at("inputs")[0].at("points") == 1);
  CHECK(json.at("inputs")[0].at("properties").at("z") == "float");
}

TEST_CASE("openings are apart from missing surface, where the cause of a hole is known", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.xyz", "1 2 3\n")}, {});
  FakeDetection found;
  for (int i = 0; i < 3; ++i) found.with_loop({1, 5, 3}, LoopKind::kHole);
  for (std::size_t i = 0; i < 3; ++i) found.measures[i].own_area = std::pow(10, i);
  found.numbers.hole_area = 111;
  ExplainedDetection detection = found;
  const auto areas = [&] {
    write_results(detection, scan, FilesConfig{}, folder / "out");
    const auto json = read_json(folder / "out/holes.json");
    CHECK(json.at("hole_area") == 111);
    return json.at("opening_area");
  };
  CHECK(areas().is_null());
  detection.causes.resize(3);
  CHECK(areas().is_null());
  detection.causes[0].shares = {1, 0, 0, 0, 0};
  CHECK(areas() == 0);
  detection.causes[1].shares = {0.4, 0.6, 0, 0, 0};
  CHECK(areas() == 10);
}

TEST_CASE("the report has every parameter, every count and one line per loop", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.xyz", "1 2 3\n")}, {});
  FakeDetection detection;
  detection.with_loop({1, 5, 3}, LoopKind::kHole).with_loop({2, 4, 8, 6}, LoopKind::kOuter);
  detection.numbers.counts.points = 10;
  detection.numbers.counts.candidates = 7;
  detection.numbers.bounds = {Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(3, 4, 5)};
  detection.numbers.phases = {{"survey", 2}, {"evaluate", 3}};
  detection.measures[1].area = std::nan("");
  FilesConfig config;
  config.neighbourhood.k = 21;
  config.selection.holes_only = true;
  write_results(detection, scan, config, folder / "out");

  const auto json = read_json(folder / "out/holes.json");
  CHECK(json.at("lacuna") == "0.1.0");
  CHECK(json.at("schema") == "holes 3");
  const auto run = read_json(folder / "out/run.json");
  for (const Parameter& parameter : parameters(config)) {
    if (parameter.section == "area") continue;
    const auto& place = parameter.section == "run" ? run : json;
    CHECK(place.at("parameters").at(std::string(parameter.section)).contains(std::string(parameter.key)));
  }
  for (const char* section : {"run", "area"}) CHECK_FALSE(json.at("parameters").contains(section));
  CHECK(json.at("parameters").at("neighbourhood").at("k") == 21);
  CHECK(json.at("parameters").at("selection").at("holes_only") == true);
  CHECK(json.at("inputs")[0].at("points") == 0);  // a text, not read yet
  CHECK(json.at("counts").at("candidates") == 7);
  CHECK(json.at("counts").at("loops") == 2);
  CHECK(json.at("counts").at("holes") == 1);
  CHECK(json.at("counts").at("outer") == 1);
  CHECK(json.at("bounds").at("max") == nlohmann::json{3, 4, 5});
  CHECK(run.at("phases")[0].at("points_per_second") == 5);
  CHECK(run.at("total_seconds") == 5);
  CHECK(json.at("loops")[1].at("kind") == "outer");
  CHECK(json.at("loops")[1].at("area").is_null());
  const nlohmann::json hole = json_of(R"({
      "id": 0, "kind": "hole", "parent": null, "confidence": 1.0, "prominence": 0.0,
      "evidence": {"clearness": 1.0, "surface": 1.0, "spacing": 0.0, "sampling_gap": 0.0, "width": 0.0, "compactness": 0.0,
                   "persistence": 0.0, "goes_on": 0.0, "layers": 0.0, "volume": 0.0, "alike": 0},
      "first_scale": 0.0, "last_scale": 0.0, "perimeter": 0.1, "area": 0.0, "diameter": 0.0,
      "planarity": 0.0, "mean_probability": 0.0, "centroid": [1, 2, 3], "normal": [0, 0, 1], "cause": null,
      "tiles": 0, "points": 3, "ids": [1, 5, 3],
      "coordinates": [[0.1, 2, 3], [0.5, 2, 3], [0.30000000000000004, 2, 3]]})");
  CHECK(json.at("loops")[0] == hole);
  CHECK_THAT(read_file(folder / "out/holes.json"), Contains("]},\n    {\"id\":1,\"kind\":\"outer\","));
  CHECK_THAT(read_file(folder / "out/holes.csv"),
             Contains("\n0,hole,3,1,0.1,0,0,1,2,3,0,0,1,,,,\n1,outer,4,1,0.1,,0,1,2,3,0,0,1,,,,\n"));
  config.output.no_coordinates = true;
  write_results(detection, scan, config, folder / "out");
  CHECK_FALSE(read_json(folder / "out/holes.json").at("loops")[0].contains("coordinates"));
}

TEST_CASE("loops.ply has the points of every loop and closes each with edges", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.ply", ascii_ply("1 2 3\n"))}, {});
  FakeDetection detection;
  detection.with_loop({1, 5, 3}, LoopKind::kHole).with_loop({2, 4, 8, 6}, LoopKind::kOuter);
  write_results(detection, scan, FilesConfig{}, folder / "out");
  const Table table = read_table(folder / "out/loops.ply");
  CHECK(table.names ==
        Names{"x", "y", "z", "scalar_loop", "scalar_id", "scalar_outer", "quality", "red", "green", "blue"});
  REQUIRE(table.rows.size() == 7);
  CHECK(table.rows[1] == std::vector<double>{0.5f, 2, 3, 0, 5, 0, 0.25, 230, 80, 30});
  CHECK(table.rows[6] == std::vector<double>{static_cast<float>(0.1 * 6), 2, 3, 1, 6, 1, 0.25, 30, 130, 230});
  Bytes edges;
  for (const std::int32_t end : {0, 1, 1, 2, 2, 0, 3, 4, 4, 5, 5, 6, 6, 3}) edges << end;
  CHECK(read_file(folder / "out/loops.ply").ends_with(edges.str()));
}

TEST_CASE("ids beyond 32 bits are written as double, and coordinates in the scan's precision", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.ply", ascii_ply("1 2 3\n", kWideXyz))}, {});
  FakeDetection detection;
  detection.with_loop({1, 2, 5'000'000'001}, LoopKind::kHole);
  detection.numbers.counts.points = 5'000'000'002;
  detection.numbers.counts.boundary_points = 1;
  detection.boundary = {{{0.1, 2, 3, PointId{5'000'000'001}}, 0.75f, 0}};
  write_results(detection, scan, FilesConfig{}, folder / "out");
  CHECK(read_table(folder / "out/loops.ply").rows.at(2)[4] == 5'000'000'001.0);
  const Table boundary = read_table(folder / "out/boundary.ply");
  CHECK(boundary.names == Names{"x", "y", "z", "scalar_probability", "scalar_id", "scalar_loop", "quality"});
  CHECK(boundary.rows == Rows{{0.1, 2, 3, 0.75, 5'000'000'001.0, 0, 0.75}});
}

TEST_CASE("points.ply joins files by property name", "[io]") {
  const ScratchFolder folder;
  const auto a = folder.write("a.ply", ascii_ply("1 2 3 9 0.5\n4 5 6 8 0.5\n7 8 9 7 0.5\n",
                                                 kXyz + "property uchar red\nproperty float depth\n"));
  const auto b = folder.write("b.ply", ascii_ply(""));
  const auto c =
      folder.write("c.ply", ascii_ply("-5 0.1 2 3 300\n-6 0 0 0 301\n",
                                      "property short tag\n" + kWideXyz + "property ushort red\n"));
  const ScanFiles scan({a, b, c}, {});
  write_results(FakeDetection().with_results(5), scan, with_points(PointsFormat::kPly), folder / "out");
  const Table table = read_table(folder / "out" / "points.ply");
  REQUIRE(table.rows.size() == 5);
  CHECK(Names(table.names.begin(), table.names.begin() + 7) ==
        Names{"x", "y", "z", "red", "depth", "tag", "scalar_probability"});
  CHECK(table.names.size() == 6 + 8);
  CHECK(table.rows[0] == std::vector<double>{1, 2, 3, 9, 0.5, 0, 0, 0.25, 0.5, 0.75, 1, 0, -1, 0});
  CHECK(table.rows[3][0] == 0.1);
  CHECK(table.rows[3][3] == 300);
  CHECK(std::isnan(table.rows[3][4]));
  CHECK(table.rows[4][5] == -6);
  CHECK(table.rows[4][6] == 4);
}

TEST_CASE("normals of the input stay, and are not written a second time", "[io]") {
  const ScratchFolder folder;
  const auto file = folder.write(
      "a.ply",
      ascii_ply("1 2 3 1 0 0\n", kXyz + "property float nx\nproperty float ny\nproperty float nz\n"));
  const ScanFiles scan({file}, {});
  write_results(FakeDetection().with_results(1), scan, with_points(PointsFormat::kPly, true), folder / "out");
  const Table table = read_table(folder / "out/points.ply");
  CHECK(table.names.size() == 6 + 8);
  CHECK(table.rows.at(0)[3] == 1);
  CHECK(open_scan(folder / "out/points.ply", {})->layout().find("scalar_coherent")->type == Scalar::kUint8);
}

TEST_CASE("an earlier result that is an input is never replaced", "[io]") {
  const FilesConfig of_each_file = with_points();
  const ScratchFolder folder;
  const auto detection = FakeDetection().with_results(1);
  for (const auto& [config, result] :
       {std::pair{with_points(PointsFormat::kPly), "out/points.ply"}, {of_each_file, "out/points/a.ply"}}) {
    const ScanFiles first({folder.write("a.ply", ascii_ply("1 2 3\n"))}, {});
    write_results(detection, first, config, folder / "out");
    const std::string content = read_file(folder / result);
    fs::create_hard_link(folder / result, folder / "linked.ply");
    for (const char* name : {result, "linked.ply"}) {
      const ScanFiles scan({folder / name}, {});
      for (const FilesConfig& next : {with_points(PointsFormat::kPly), of_each_file, FilesConfig{}})
        CHECK_THAT(error_of([&] { write_results(detection, scan, next, folder / "out"); }),
                   Contains(std::string(name) + ": is an input in the place of a result"));
    }
    CHECK(read_file(folder / result) == content);
    fs::remove(folder / "linked.ply");
    CHECK(folder.names() == Names{"a.ply", "out"});
  }
}

TEST_CASE("an input that changed during the run is an error that leaves no result", "[io]") {
  const ScratchFolder folder;
  const ScanFiles scan({folder.write("a.ply", ascii_ply("1 2 3\n4 5 6\n"))}, {});
  for (const std::size_t results : {1u, 3u}) {
    CHECK_THAT(error_of([&] {
                 write_results(FakeDetection().with_results(results), scan, with_points(PointsFormat::kPly),
                               folder / "out");
               }),
               Contains("the input has changed"));
    CHECK(folder.names() == Names{"a.ply"});
  }
}

TEST_CASE("the offset is the middle of the scan without its strays in whole units, 0 without points",
          "[io]") {
  OutputConfig config;
  FakeDetection detection;
  CHECK_FALSE(local_offset(detection, config));
  config.local_coordinates = true;
  CHECK(*local_offset(detection, config) == Eigen::Vector3d(0, 0, 0));
  detection.numbers.bounds = {Eigen::Vector3d(-1e6, -2, 0), Eigen::Vector3d(500'000, 5'400'000, 7)};
  detection.numbers.strays.rest = {Eigen::Vector3d(400'000, -2, -0.25), Eigen::Vector3d(500'001, 1.5, 0)};
  const Eigen::Vector3d offset = *local_offset(detection, config);
  CHECK(offset == Eigen::Vector3d(450'001, 0, 0));
  CHECK(print_offset(offset) == "lacuna offset 450001 0 0");  // and no -0
  CHECK(print_offset({-1e22, 0.5, 1e5}) == "lacuna offset -10000000000000000000000 0.5 100000");
}

TEST_CASE("what is too far from the offset for a float is infinite", "[io]") {
  CHECK(nearest_float(1e39) == std::numeric_limits<float>::infinity());
  CHECK(nearest_float(-1e300) == -std::numeric_limits<float>::infinity());
  CHECK(nearest_float(0.1) == 0.1f);
  CHECK(nearest_float(3.4e38) == 3.4e38f);
  CHECK(std::isnan(nearest_float(std::nan(""))));
}

TEST_CASE("an offset in a header is added to the positions, and to nothing else", "[io]") {
  const ScratchFolder folder;
  const std::string ply =
      ply_header("comment lacuna offset 500000 -2.5 1e3\n" +
                 vertices(2,
                          "property float nx\nproperty uchar X\nproperty float y\nproperty double z\n"
                          "property float quality\n")) +
      "1 2 0.5 3 4\n5 6 nan 7 8\n";
  const Table table = read_table(folder.write("a.ply", ply), 1);
  CHECK(table.names == std::vector<std::string>{"nx", "x", "y", "z", "quality"});
  CHECK(table.rows[0] == std::vector<double>{1, 500'002, -2, 1003, 4});
  CHECK(table.rows[1][1] == 500'006);
  CHECK(std::isnan(table.rows[1][2]));
  CHECK(table.rows[1][3] == 1007);
}

TEST_CASE("an offset that is not three finite numbers, or a second one, is an error with its line", "[io]") {
  const auto with = [](const std::string& comment) {
    return ply_header("comment " + comment + "\n" + vertices(1)) + "1 2 3\n";
  };
  std::vector<Wrong> cases = {
      {with("lacuna offset 1 2 3\ncomment lacuna offset 1 2 3"), "line 4: a second 'lacuna offset'"}};
  for (const std::string numbers : {"", " 1 2", " 1 2 3 4", " 1 2 x", " 1 2 nan", " inf 2 3"})
    cases.push_back({with("lacuna offset" + numbers), "line 3: 'lacuna offset X Y Z' with three numbers"});
  check_refused("a.ply", cases);
  const ScratchFolder folder;
  for (const char* other : {"offset 1 2", "lacuna", "lacuna detect", "lacuna offsets", "lacuna offset 1 2 3"})
    CHECK(read_error(folder.write("a.ply", with(other))).empty());
}

namespace {

using namespace io;

TEST_CASE("polygons cover the share of each cell that lies within them, without their inner rings") {
  struct Case {
    std::vector<Ring2> polygon;
    std::size_t columns, rows;
    std::vector<float> shares;
  };
  const Case cases[] = {
      {{Ring2{{0.5, 0.5}, {2.25, 0.5}, {2.25, 2}, {0.5, 2}}}, 3, 2, {0.5F, 1, 0.25F, 0.25F, 0.5F, 0.125F}},
      {{Ring2{{0, 0}, {4, 0}, {4, 1}, {3, 1}, {3, 0.5}, {1, 0.5}, {1, 1}, {0, 1}}}, 4, 1, {1, 0.5F, 0.5F, 1}},
      {{Ring2{{0, 0}, {4, 0}, {4, 1}, {0, 1}}, Ring2{{1, 0.25}, {1, 0.75}, {2.5, 0.75}, {2.5, 0.25}}},
       4,
       1,
       {1, 0.5F, 0.75F, 1}},
      {{Ring2{{-5, -5}, {1.5, -5}, {1.5, 7}, {-5, 7}}}, 2, 1, {1, 0.5F}},     // beyond the grid
      {{Ring2{{10, 10}, {12, 10}, {11, 12}}}, 2, 1, {0, 0}},                  // outside of it
      {{Ring2{{0.2, 0.3}, {0.8, 0.3}, {0.8, 0.3}, {0.2, 0.3}}}, 1, 1, {0}}};  // seen from its edge
  for (const Case& c : cases) {
    CoverageGrid grid{
        .corner = {0, static_cast<double>(c.rows)}, .edge = 1, .columns = c.columns, .rows = c.rows};
    grid.points.resize(grid.size());
    grid.holes.resize(grid.size());
    add_polygon(c.polygon, grid);
    CHECK(grid.holes == c.shares);
  }
}

}  // namespace

}  // namespace lacuna::test
