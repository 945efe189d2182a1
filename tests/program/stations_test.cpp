// SPDX-License-Identifier: Apache-2.0
// lacuna stations on the results of runs: places that are given, and next_stations.geojson.
#include "tests/support/clouds.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

using nlohmann::json;

// The results of a sheet with a hole, whose middle lies 5 below a place.
class Surveyed {
 public:
  explicit Surveyed(const Eigen::Vector3d& place, const std::vector<std::string>& options = {}) {
    const Cloud cloud = plane(30).punched({15, 15}, 5).translated(place - Eigen::Vector3d(15, 15, 5));
    detect(scratch_.write("scan.txt", cloud.text()), out(), options);
  }

  std::string out() const { return (scratch_ / "out").string(); }
  fs::path written() const { return scratch_ / "out" / "next_stations.geojson"; }
  const ScratchFolder& scratch() const { return scratch_; }

  ProgramResult stations(const std::string& places, const Words& options = {}) const {
    const std::string file = scratch_.write("places.txt", places);
    return run_program(with({"stations", out(), "--range", "100", "--places", file}, options));
  }

 private:
  ScratchFolder scratch_;
};

const Eigen::Vector3d kPlace(500'000, 5'400'000, 100);  // in EPSG:25832: 9 degrees east, kLatitude north
constexpr const char* kLine = "500000 5400000 100\n";
constexpr double kLatitude = 48.7530130054242;  // by gdaltransform

json place_of(const json& feature) {
  const json& properties = feature.at("properties");
  return {properties.at("x"), properties.at("y"), properties.at("z")};
}

}  // namespace

TEST_CASE("given places are tried instead of those over the floor, and have their names", "[program]") {
  const Surveyed surveyed(kPlace);
  const ProgramResult run = surveyed.stations(
      "name x y z\nfar 900000 5400000 100\nabove 500000 5400000 100\n500010 5400000 96\n\xff 500000 5400010 "
      "96\n");
  REQUIRE(run.exit_code == 0);
  CHECK(count_lines(run.err) == 1);
  CHECK_THAT(run.err, Contains("no cause of a hole is known"));
  CHECK_THAT(run.out, Contains("within holes: "));
  CHECK_THAT(run.out, Contains("4 places of ") && Contains("were tried") && Contains("name"));
  CHECK_THAT(run.out, Contains("above  500000.0 5400000.0 100.0"));
  const json features = read_json(surveyed.written()).at("features");
  REQUIRE(features.size() == 1);  // the others see what the first one does
  CHECK(place_of(features[0]) == json{500'000, 5'400'000, 100});
  CHECK(features[0].at("properties").at("name") == "above");
  CHECK(features[0].at("properties").at("rank") == 1);

  const ProgramResult nameless = surveyed.stations(kLine);
  CHECK(nameless.exit_code == 0);
  CHECK_THAT(nameless.out, !Contains("name"));
  CHECK_FALSE(read_json(surveyed.written()).at("features")[0].at("properties").contains("name"));
  REQUIRE(surveyed.stations("\xff 500000 5400000 100\n").exit_code == 0);
  CHECK(read_json(surveyed.written()).at("features")[0].at("properties").at("name") == "\xEF\xBF\xBD");
  REQUIRE(surveyed.stations("900000 5400000 100\n").exit_code == 0);
  CHECK(read_json(surveyed.written()).at("features").empty());
}

TEST_CASE("a run of stations that finds no place says why", "[program]") {
  const auto check = [](const ProgramResult& run, const std::string& reason) {
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.err, Contains("no next station: ") && Contains(reason));
  };
  const Surveyed surveyed(kPlace);
  check(surveyed.stations("900000 5400000 100\n"), "all is farther");
  check(surveyed.stations("500020 5400000 95.1\n"), "rays come at");
  const ScratchFolder scratch;
  const auto run_on = [&](const Cloud& cloud) {
    const fs::path out = detect(scratch.write("scan.txt", cloud.text()), scratch / "out");
    return run_program({"stations", out.string()});
  };
  const Cloud sheet = plane(30).punched({15, 15}, 5);
  check(run_on(plane(30)), "the results have no hole");
  check(run_on(sheet.rotated({1, 0, 0}, 90)), "would be if y were up");
  check(run_on(sheet.rotated({1, 1, 0}, 45)), "no points of the sample are level");
}

TEST_CASE("a list of places that cannot be read leaves the earlier result", "[program]") {
  const Surveyed surveyed(kPlace);
  REQUIRE(surveyed.stations(kLine).exit_code == 0);
  const std::string before = read_file(surveyed.written());
  check_failure(surveyed.stations("1 2 3\na 1 2 x\n"), 1, "places.txt: line 2: 'x' is not a number");
  check_failure(run_program({"stations", surveyed.out(), "--places", ""}), 1, "cannot be opened");
  for (const char* const option : {"--height", "--grid"})
    check_failure(surveyed.stations(kLine, {option, "2"}), 2, std::string(option) + " excludes --places");
  CHECK(read_file(surveyed.written()) == before);
}

TEST_CASE("next_stations.geojson is in longitude, latitude and height, with places of the scan as properties",
          "[program]") {
  struct Case {
    std::string crs;
    Eigen::Vector3d place;
    std::vector<double> coordinates;
  };
  constexpr double kTwelveFeet = 12 * 1200.0 / 3937;  // in metres, as RFC 7946 has heights
  const Case cases[] = {
      {"EPSG:25832", kPlace, {9, kLatitude, 100}},
      {"EPSG:25832+7837", kPlace, {9, kLatitude, 100}},
      {"EPSG:2263", {984'250, 0, 12}, {-74, 40 + 1 / 6.0, kTwelveFeet}},  // the origin of the system, in feet
      {"EPSG:2263+6360", {984'250, 0, 12}, {-74, 40 + 1 / 6.0, kTwelveFeet}},
      {"EPSG:4978", {6'378'237, 0, 0}, {0, 0, 100}},  // geocentric
  };
  for (const Case& c : cases) {
    INFO(c.crs);
    const Surveyed surveyed(c.place, {"--crs", c.crs});
    std::ostringstream line;
    line.precision(17);
    line << c.place.transpose();
    const ProgramResult run = surveyed.stations(line.str());
    REQUIRE(run.exit_code == 0);
    CHECK(count_lines(run.err) == 1);  // no cause is known
    const json written = read_json(surveyed.written());
    REQUIRE(written.at("features").size() == 1);
    const json& feature = written.at("features")[0];
    CHECK(place_of(feature).get<std::vector<double>>() ==
          std::vector<double>(c.place.data(), c.place.data() + 3));
    const auto coordinates = feature.at("geometry").at("coordinates").get<std::vector<double>>();
    REQUIRE(coordinates.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(coordinates[i] == Approx(c.coordinates[i]).margin(i < 2 ? 1e-9 : 1e-6));
    CHECK(written.at("crs_of_coordinates") == "OGC:CRS84");
    CHECK(written.at("crs_of_x_y_z") == read_json(fs::path(surveyed.out()) / "holes.json").at("crs"));
  }
}

TEST_CASE("without a way to degrees, next_stations.geojson has the coordinates of the scan", "[program]") {
  const Surveyed surveyed(kPlace);
  const auto check = [&](const ProgramResult& run, const json& crs) {
    REQUIRE(run.exit_code == 0);
    const json written = read_json(surveyed.written());
    const json& feature = written.at("features").at(0);
    CHECK(feature.at("geometry").at("coordinates") == json{500'000, 5'400'000, 100});
    CHECK(place_of(feature) == feature.at("geometry").at("coordinates"));
    CHECK(written.at("crs_of_coordinates") == crs);
    CHECK(written.at("crs_of_x_y_z") == crs);
  };
  const ProgramResult plain = surveyed.stations(kLine);
  check(plain, nullptr);
  CHECK(count_lines(plain.err) == 1);  // no cause is known

  const fs::path holes = fs::path(surveyed.out()) / "holes.json";
  const auto state = [&](const std::string& crs) {
    json report = read_json(holes);
    report["crs"] = crs;
    std::ofstream(holes) << report;
  };
  for (const std::string crs : {"LOCAL_CS[\"site\",UNIT[\"metre\",1]]", "nonsense"}) {
    state(crs);
    const ProgramResult run = surveyed.stations(kLine);
    check(run, crs);
    CHECK_THAT(run.err, Contains("next_stations.geojson: GDAL cannot convert") && Contains("as degrees"));
    CHECK(count_lines(run.err) == 2);
  }
  state("EPSG:25832");
  const fs::path alone = surveyed.scratch() / "lacuna";  // a program without lacuna_gis.so
  fs::copy_file(LACUNA_PROGRAM, alone);
  const ProgramResult run = run_command({alone.string(), "stations", surveyed.out(), "--range", "100",
                                         "--places", surveyed.scratch().write("places.txt", kLine)});
  check(run, "EPSG:25832");
  CHECK_THAT(run.err, Contains("lacuna_gis.so is missing"));
}

TEST_CASE("a trajectory is one station with the length of its path", "[program]") {
  const ScratchFolder scratch;
  const std::string scan = synth("scan", scratch / "street.ply",
                                 {"--scene", "street", "--stations", "1", "--drive", "--points", "200000"}),
                    out = (scratch / "out").string();
  const std::string path = (scratch / "street.trajectory.txt").string();
  detect(scan, out, {"--stations", path});
  const json report = read_json(fs::path(out) / "holes.json");
  REQUIRE(report.at("stations").size() == 1);
  CHECK(report.at("stations")[0].at("path") == Approx(42));
  bool has_hidden = false;
  for (const json& loop : report.at("loops")) {
    if (loop.at("cause").is_null() || loop.at("cause").at("hidden_by").is_null()) continue;
    has_hidden = true;
    const json from = loop.at("cause").at("hidden_by").at("from");
    CHECK(from[1] == Approx(8));  // on the path
    CHECK(from[2] == Approx(1.9));
  }
  CHECK(has_hidden);
  CHECK_THAT(run_program({"info", scan, "--stations", path}).out, Contains("moved 42"));
}

}  // namespace lacuna::test
