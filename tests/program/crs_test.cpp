// SPDX-License-Identifier: Apache-2.0
// The coordinate reference system and the unit of a scan, as its files name them and as the user states them.
#include "tests/support/clouds.hpp"
#include "tests/support/json.hpp"
#include "tests/support/las_file.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

constexpr const char* kUtm = "ETRS89 / UTM zone 32N";

// A sheet with a hole, in UTM coordinates.
std::string sheet_text() {
  return plane(30).punched({15, 15}, 5).translated({500'000, 5'400'000, 100}).text();
}

std::string degrees_las() {
  LasFile las;
  las.records = {
      las_record("LASF_Projection", 2112,
                 "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
                 "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]")};
  for (int i = 0; i < 100; ++i) las.points.push_back(las_point(20, i % 10, i / 10, 0));
  las.scale = {1e-6, 1e-6, 0.01};
  las.offset = {9, 48, 100};
  return las.bytes();
}

}  // namespace

TEST_CASE("a system whose lengths are not those on the ground is refused, with the UTM zone of the scan") {
  const ScratchFolder scratch;
  // Web Mercator stretches lengths by 1.5 at 48 degrees north, and by 1 at the equator.
  const std::string north = scratch.write(
      "north.xyz", plane(30).punched({15, 15}, 5).translated({1'000'000, 6'100'000, 100}).text());
  const std::string equator =
      scratch.write("equator.xyz", plane(30).punched({15, 15}, 5).translated({1'000'000, 100, 100}).text());
  const auto detect = [&](const std::string& scan, const std::string& crs) {
    return run_program({"detect", scan, "--out", (scratch / "out").string(), "--crs", crs});
  };
  check_failure(detect(north, "EPSG:3857"), 1, "EPSG:32632");
  CHECK(detect(equator, "EPSG:3857").exit_code == 0);
  check_failure(detect(north, "EPSG:3395"), 1, "EPSG:32632");
}

TEST_CASE("a scan in degrees is refused before the work with the ways out, and info says so") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("degrees.las", degrees_las());
  const std::string out = (scratch / "out").string();
  check_failure(run_program({"detect", scan, "--out", out}), 1, "`pdal translate");
  CHECK_FALSE(fs::exists(out));
  CHECK_THAT(run_program({"info", scan}).out, Contains("unit        degrees"));
  CHECK(json_of(run_program({"info", scan, "--json"}).out)["files"][0]["unit"] == "degree");
  const ProgramResult stated = run_program({"detect", scan, "--out", out, "--crs", "EPSG:25832"});
  CHECK(stated.exit_code == 0);
  CHECK_THAT(stated.err, Contains("WGS 84; the stated one holds, " + std::string(kUtm)));
}

TEST_CASE("the option --crs states the system and the unit of any file, in every result that has them") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("sheet.xyz", sheet_text());
  const auto detect = [&](const Words& options) {
    const ProgramResult result =
        succeed(with({"detect", scan, "--out", (scratch / "out").string()}, options));
    return std::pair(result.out, read_json(scratch / "out" / "holes.json"));
  };
  const auto [plain, none] = detect({});
  CHECK(none["crs"].is_null());
  CHECK(none["unit"] == "");
  CHECK_THAT(plain, !Contains("crs"));

  const auto [output, holes] = detect({"--crs", "EPSG:25832", "--report"});
  const std::string text = holes["crs"];
  CHECK_THAT(text, StartsWith("PROJCS[\"" + std::string(kUtm)) && Contains("AUTHORITY[\"EPSG\",\"25832\"]"));
  CHECK(holes["unit"] == "m");
  CHECK(holes["loops"] == none["loops"]);
  CHECK(read_json(scratch / "out" / "run.json")["crs"] == text);
  CHECK(read_json(scratch / "out" / "run.json")["unit"] == "m");
  CHECK_THAT(output, Contains("crs          " + std::string(kUtm)) && Contains(" m²"));
  CHECK_THAT(read_file(scratch / "out" / "report.html"), Contains(kUtm) && Contains("\"unit\":\"m\""));
  CHECK_THAT(run_program({"info", scan, "--crs", "EPSG:25832"}).out,
             Contains("crs           " + std::string(kUtm)) && Contains("unit          m\n"));

  // A file and the config state it as well.
  CHECK(detect({"--crs", scratch.write("utm.prj", text + "\n")}).second["crs"] == text);
  const std::string config = scratch.write("c.toml", "[input]\ncrs = \"EPSG:25832\"\n");
  CHECK(detect({"--config", config}).second["crs"] == text);
  CHECK_THAT(detect({"--unit", "us-ft"}).first, Contains(" us-ft²"));
  for (const char* code : {"EPSG:25832+7837", "EPSG:4978"})
    CHECK(detect({"--crs", code}).second["unit"] == "m");
}

TEST_CASE("a system of no lengths is an error before the work") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("sheet.xyz", sheet_text()), out = (scratch / "out").string();
  for (const char* code : {"EPSG:4326", "EPSG:4979", "EPSG:4326+5773"})
    check_failure(run_program({"detect", scan, "--out", out, "--crs", code}), 1,
                  "is in longitude and latitude, and holes need lengths");
  CHECK_FALSE(fs::exists(out));
}

}  // namespace lacuna::test
