// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/crs.hpp"

#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

// As GDAL writes it, with another unit. lacuna_gis.so is in the folder of this program.
const std::string kGeogcs = known_system("GEOGCS");
const std::string kVertical = "VERT_CS[\"height\",VERT_DATUM[\"d\",2005],UNIT[\"foot\",0.3048]]";

std::string compound(const std::string& flat) {
  return "COMPD_CS[\"both\"," + flat + "," + kVertical + "]";
}

}  // namespace

TEST_CASE("well-known text of both kinds says what positions are, and a broken one says nothing") {
  const auto kind = [](const std::string& crs) {
    const CrsFacts& facts = facts_of(crs);
    return facts.is_geographic   ? "degrees"
           : facts.is_geocentric ? "centre"
           : facts.has_positions ? "plan"
                                 : "";
  };
  const std::string datum = "\"WGS 84\",DATUM[\"WGS 84\",ELLIPSOID[\"WGS 84\",6378137,298.257223563]],";
  const std::string solid = "GEODCRS[" + datum + "CS[Cartesian,3],AXIS[\"(X)\",geocentricX],AXIS[\"(Y)\"," +
                            "geocentricY],AXIS[\"(Z)\",geocentricZ],LENGTHUNIT[\"metre\",1]]";
  const std::string degrees = "GEOGCRS [ " + datum + "CS[ellipsoidal,2],AXIS[\"latitude\",north]," +
                              "AXIS[\"longitude\",east],ANGLEUNIT[\"degree\",0.0174532925199433]]";
  for (const std::string& crs : {kGeogcs, compound(kGeogcs), degrees, std::string("EPSG:4326")})
    CHECK(kind(crs) == std::string("degrees"));
  for (const std::string& crs : {solid, std::string("EPSG:4978")}) CHECK(kind(crs) == std::string("centre"));
  for (const std::string& crs :
       {known_system("a [b] (c)"), compound(known_system("a")), std::string("EPSG:25832+7837"),
        std::string("LOCAL_CS[\"GEOGCS[site]\",UNIT[\"metre\",1]]")})
    CHECK(kind(crs) == std::string("plan"));
  for (const char* none : {"", "EPSG:7837", "EPSG:1", "GEOGCS", "\"GEOGCS[\"", "[", "]]", "MY_GEOGCS[\"a\"]"})
    CHECK(kind(none) == std::string());
}

TEST_CASE("a system has the code and the text of its horizontal part") {
  const std::string flat = known_system("a", "metre\",1", 25832);
  CHECK(facts_of(flat).code == "EPSG:25832");
  CHECK(facts_of(compound(flat)).code == "EPSG:25832");
  CHECK(facts_of(known_system("a")).code.empty());
  CHECK(without_vertical(flat) == flat);
  CHECK(name_of_crs(without_vertical(compound(flat))) == "a");
  CHECK(without_vertical("EPSG:25832+7837") == "EPSG:25832");
  CHECK(facts_of("EPSG:25832+1").horizontal == facts_of("EPSG:25832").known_text);
  CHECK_FALSE(facts_of("EPSG:25832+1").is_whole);
}

TEST_CASE("a unit has its length in metres, and the length its unit") {
  CHECK(metres_of_unit("m") == 1);
  CHECK(metres_of_unit("mm") == 0.001);
  CHECK(metres_of_unit("ft") == 0.3048);
  CHECK(metres_of_unit("us-ft") == Approx(0.3048006096).epsilon(1e-10));
  for (const std::string unit : {"m", "km", "cm", "mm", "ft", "us-ft", "in", "yd"}) {
    REQUIRE(metres_of_unit(unit));
    CHECK(unit_of_metres(*metres_of_unit(unit)) == unit);
  }
  for (const char* const none : {"", "M", "metre", "ft ", "fathom"}) CHECK_FALSE(metres_of_unit(none));
}

TEST_CASE("the unit of a system is the unit of its lengths, by its size") {
  const std::pair<const char*, const char*> units[] = {{"metre\",1", "m"},
                                                       {"foot\",0.3048", "ft"},
                                                       {"US survey foot\",0.304800609601219", "us-ft"},
                                                       {"US foot\",0.3048006", "us-ft"},
                                                       {"millimetre\",0.001", "mm"},
                                                       {"fathom\",1.8288", ""}};
  for (const auto& [unit, name] : units) {
    CHECK(length_unit(known_system("a", unit)) == name);
    CHECK(length_unit(compound(known_system("a", unit))) == name);
    CHECK(vertical_unit(known_system("a", unit)).empty());
  }
  CHECK(vertical_unit(compound(known_system("a"))) == "ft");
  CHECK(length_unit("LOCAL_CS[\"UNIT[x]\",UNIT[\"foot\",0.3048]]") == "ft");
  for (const char* code : {"EPSG:25832", "EPSG:25832+7837", "EPSG:4978", "ESRI:102100"})
    CHECK(length_unit(code) == "m");
  for (const std::string& none : {kGeogcs, std::string("EPSG:4326"), std::string("EPSG:1"), std::string()})
    CHECK(length_unit(none).empty());
}

namespace {

const std::string kUtm = known_system("UTM 32N");

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

TEST_CASE("a system is stated by its text, by a file of it, or by a code") {
  const ScratchFolder folder;
  const std::string file = folder.write("a.prj", "\xEF\xBB\xBF " + kUtm + "\r\n");
  for (const std::string& given : {kUtm, " " + kUtm + "\n", file}) {
    CHECK(stated(given).crs == kUtm);
    CHECK(stated(given).unit == "m");
  }
  const std::string code = folder.write("code", "EPSG:25832\n");
  for (const std::string& given : {std::string("EPSG:25832"), code}) {
    CHECK(stated(given).crs == facts_of("EPSG:25832").known_text);
    CHECK(stated(given).unit == "m");
  }
  CHECK(stated("").crs.empty());
  CHECK(stated("", LengthUnit::kMm).unit == "mm");
}

TEST_CASE("what is no system, and a unit that contradicts it, are errors that say what is allowed") {
  const ScratchFolder folder;
  const std::string empty = folder.write("empty.prj", "\n");
  const std::string large = folder.write("large.prj", std::string(std::size_t{1} << 20, ' '));
  for (const std::string& given :
       {std::string("25832"), std::string("EPSG:"), std::string("EPSG:x"), std::string("missing.prj"), empty})
    CHECK_THAT(refusal(given), Contains("--crs " + given + ": is no coordinate reference system; allowed: "));
  CHECK_THAT(refusal(" "), Contains("--crs : is no coordinate reference system"));
  CHECK_THAT(refusal(kVertical), Contains("is no system of positions"));
  CHECK_THAT(refusal("VERT_CS[\n\"" + std::string(1000, 'x') + "\"]"),
             Contains("--crs VERT_CS[...: GDAL knows no such system"));
  CHECK_THAT(refusal("VERT_CS[\"" + std::string(1000, 'x') + "\"]"), Contains("xxx...: GDAL knows no"));
  CHECK_THAT(refusal(large), Contains("large.prj") && Contains("too large"));
  CHECK_THAT(refusal((folder / "").string()), Contains("folder") || Contains("regular"));
  CHECK(stated(kUtm, LengthUnit::kM).unit == "m");
  CHECK_THAT(refusal(kUtm, LengthUnit::kFt), Contains("--unit ft: contradicts --crs"));
}

TEST_CASE("a text and a code of one system are the same, others are not") {
  CHECK(is_same_crs(kUtm, kUtm));
  CHECK(is_same_crs("", ""));
  CHECK(is_same_crs(facts_of("EPSG:25832").known_text, "EPSG:25832"));
  CHECK_FALSE(is_same_crs(kUtm, ""));
  CHECK_FALSE(is_same_crs(kUtm, "EPSG:25833"));
}

}  // namespace lacuna::test
