// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/crs.hpp"

#include "io/read/crs/crs_text.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {
namespace {

const std::string kGeogcs =
    "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
    "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
    "UNIT[\"degree\",0.0174532925199433]]";
const std::string kVertical = "VERT_CS[\"height\",VERT_DATUM[\"d\",2005],UNIT[\"foot\",0.3048]]";

std::string projcs(const std::string& unit) {
  return "PROJCS[\"a [b] (c)\"," + kGeogcs + ",PROJECTION[\"Transverse_Mercator\"],UNIT[\"" + unit + "]," +
         "AXIS[\"Easting\",EAST]]";
}

}  // namespace

TEST_CASE("well-known text of both kinds says whether positions are longitude and latitude") {
  CHECK(is_geographic(kGeogcs));
  CHECK(is_geographic("COMPD_CS[\"both\"," + kGeogcs + "," + kVertical + "]"));
  CHECK(is_geographic("GEOGCRS[\"WGS 84\",CS[ellipsoidal,2]]"));
  CHECK(is_geographic("geogcrs(\"WGS 84\",cs(ellipsoidal,3))"));
  CHECK(is_geographic("GEODCRS[\"WGS 84\",DATUM[\"d\"],CS[ellipsoidal,3]]"));
  CHECK(is_geographic("BOUNDCRS[SOURCECRS[GEOGCRS[\"a\"]],TARGETCRS[GEOGCRS[\"b\"]]]"));

  CHECK_FALSE(is_geographic(projcs("metre\",1")));
  CHECK_FALSE(is_geographic("COMPD_CS[\"both\"," + projcs("metre\",1") + "," + kVertical + "]"));
  CHECK_FALSE(is_geographic("PROJCRS[\"a\",BASEGEOGCRS[\"b\"],CS[Cartesian,2]]"));
  CHECK_FALSE(is_geographic("BOUNDCRS[SOURCECRS[PROJCRS[\"a\"]],TARGETCRS[GEOGCRS[\"b\"]]]"));
  CHECK_FALSE(is_geographic("GEODCRS[\"WGS 84\",DATUM[\"d\"],CS[Cartesian,3]]"));
  CHECK_FALSE(is_geographic("GEOCCS[\"WGS 84\"]"));
  CHECK_FALSE(is_geographic("LOCAL_CS[\"GEOGCS[site]\",UNIT[\"metre\",1]]"));
  for (const char* none : {"", "EPSG:4326", "GEOGCS", "\"GEOGCS[\"", "[", "]]", "MY_GEOGCS[\"a\"]"})
    CHECK_FALSE(is_geographic(none));
}

TEST_CASE("the horizontal part of a compound system is a node of its own, also where the text is cut") {
  const std::string flat = projcs("metre\",1");
  CHECK(horizontal_system("COMPD_CS[\"both\"," + flat + "," + kVertical + "]") == flat);
  CHECK(horizontal_system(kVertical).empty());
  CHECK(horizontal_system("EPSG:25832").empty());
  for (std::size_t length = 0; length < flat.size(); ++length)
    CHECK(horizontal_system(flat.substr(0, length)) == (length < 7 ? "" : flat.substr(0, length)));
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

TEST_CASE("the unit of a system is that of its lengths, by its size") {
  CHECK(length_unit(projcs("metre\",1")) == "m");
  CHECK(length_unit(projcs("foot\",0.3048")) == "ft");
  CHECK(length_unit(projcs("US survey foot\",0.304800609601219")) == "us-ft");
  CHECK(length_unit(projcs("US survey foot\",0.3048006")) == "us-ft");
  CHECK(length_unit(projcs("millimetre\",0.001")) == "mm");
  CHECK(length_unit(projcs("fathom\",1.8288")).empty());
  CHECK(length_unit("COMPD_CS[\"both\"," + projcs("metre\",1") + "," + kVertical + "]") == "m");
  CHECK(length_unit("GEOCCS[\"WGS 84\",DATUM[\"d\"],PRIMEM[\"Greenwich\",0],UNIT[\"metre\",1]]") == "m");
  CHECK(length_unit(kGeogcs).empty());
  CHECK(length_unit("GEOGCRS[\"a\",DATUM[\"d\",ELLIPSOID[\"e\",6378137,298,LENGTHUNIT[\"metre\",1]]]]")
            .empty());
  CHECK(length_unit("EPSG:25832").empty());
}

TEST_CASE("well-known text may have blanks before and after brackets") {
  const std::string text =
      "PROJCS [ \"UTM\", GEOGCS [ \"WGS 84\", UNIT [ \"degree\", 0.01745] ],\n UNIT [ \"metres\" , 0.3048 ] "
      ", "
      "AXIS [\"E\", EAST] ]";
  CHECK(length_unit(text) == "ft");
  CHECK(length_unit("LOCAL_CS[\"UNIT[x]\",UNIT(\"m\",1.0)]") == "m");
  CHECK(length_unit(
            "PROJCRS[\"a\",CS[Cartesian,2],AXIS[\"x\",east],LENGTHUNIT [\"metre\", 1,ID[\"EPSG\",9001]]]") ==
        "m");
  CHECK(is_geographic("GEODCRS [\"WGS 84\", CS [ellipsoidal, 3]]"));
}

TEST_CASE("geocentric systems are those from the centre of the Earth") {
  CHECK(is_geocentric("GEOCCS[\"WGS 84\",UNIT[\"metre\",1]]"));
  CHECK(is_geocentric("GEODCRS[\"WGS 84\",CS[Cartesian,3]]"));
  CHECK_FALSE(is_geocentric("GEODCRS[\"WGS 84\",CS[ellipsoidal,3]]"));
  CHECK_FALSE(is_geocentric("PROJCRS[\"a\",BASEGEODCRS[\"b\"],CS[Cartesian,2]]"));
  CHECK_FALSE(is_geocentric(""));
}

namespace {

// Without lacuna_gis.so, which is not in the folder of this program.

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
