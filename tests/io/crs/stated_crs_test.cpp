// SPDX-License-Identifier: Apache-2.0
// Without lacuna_gis.so, which is not in the folder of this program.
#include "io/read/crs/crs.hpp"

#include "tests/support/test.hpp"

namespace lacuna::test {
namespace {

const std::string kUtm = "PROJCS[\"UTM 32N\",GEOGCS[\"ETRS89\",UNIT[\"degree\",0.01745]],UNIT[\"metre\",1]]";

StatedCrs stated(const std::string& crs, LengthUnit unit = LengthUnit::kInput) {
  InputConfig config;
  config.crs = crs;
  config.unit = unit;
  return read_stated_crs(config);
}

std::string refusal(const std::string& crs, LengthUnit unit = LengthUnit::kInput) {
  return error_of([&] { stated(crs, unit); });
}

}  // namespace

TEST_CASE("a system is stated by its text, by a file of it, or by a code that stays one") {
  const ScratchFolder folder;
  const std::string file = folder.write("a.prj", "\xEF\xBB\xBF " + kUtm + "\r\n");
  for (const std::string& given : {kUtm, " " + kUtm + "\n", file}) {
    CHECK(stated(given).crs == kUtm);
    CHECK(stated(given).unit == "m");
  }
  const std::string code = folder.write("code", "EPSG:25832\n");
  for (const std::string& given : {std::string("EPSG:25832"), code}) {
    CHECK(stated(given).crs == "EPSG:25832");
    CHECK(stated(given).unit.empty());
    CHECK(stated(given, LengthUnit::kUsFt).unit == "us-ft");
  }
  CHECK(stated("EPSG:25832+7837").crs == "EPSG:25832+7837");
  CHECK(stated("").crs.empty());
  CHECK(stated("", LengthUnit::kMm).unit == "mm");
}

TEST_CASE("what is no system, and a unit that contradicts it, are errors that say what is allowed") {
  const ScratchFolder folder;
  const std::string empty = folder.write("empty.prj", "\n");
  const std::string large = folder.write("large.prj", std::string(std::size_t{1} << 20, ' '));
  for (const std::string& given : {std::string("25832"), std::string("EPSG:"), std::string("EPSG:x"),
                                   std::string("missing.prj"), std::string("VERT_CS[\"height\"]"), empty})
    CHECK_THAT(refusal(given), Contains("--crs " + given + ": is no coordinate reference system; allowed: "));
  CHECK_THAT(refusal(" "), Contains("--crs : is no coordinate reference system"));
  CHECK_THAT(refusal("VERT_CS[\n\"" + std::string(1000, 'x') + "\"]"), Contains("--crs VERT_CS[...: is no"));
  CHECK_THAT(refusal("VERT_CS[\"" + std::string(1000, 'x') + "\"]"), Contains("xxx...: is no"));
  CHECK_THAT(refusal(large), Contains("large.prj") && Contains("too large"));
  CHECK_THAT(refusal((folder / "").string()), Contains("folder") || Contains("regular"));
  CHECK(stated(kUtm, LengthUnit::kM).unit == "m");
  CHECK_THAT(refusal(kUtm, LengthUnit::kFt), Contains("--unit ft: contradicts --crs"));
}

TEST_CASE("systems with different texts are not the same without GDAL") {
  CHECK(is_same_crs(kUtm, kUtm));
  CHECK(is_same_crs("", ""));
  CHECK_FALSE(is_same_crs(kUtm, ""));
  CHECK_FALSE(is_same_crs(kUtm, "EPSG:25832"));
}

}  // namespace lacuna::test
