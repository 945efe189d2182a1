// SPDX-License-Identifier: Apache-2.0
#include "io/read/las/las_header.hpp"

#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

using Key = std::array<std::uint16_t, 4>;  // key, place, count, value

void take(LasCrs& crs, std::uint16_t record, const std::string& data) {
  crs.take(record, std::as_bytes(std::span(data)));
}

std::string crs_of_keys(const std::vector<Key>& keys) {
  LasCrs crs;
  take(crs, 34735, las_geo_keys(keys));
  return crs.text();
}

}  // namespace

TEST_CASE("GeoTIFF keys give codes of EPSG, the projected before the geographic, with the vertical") {
  const std::vector<std::pair<std::vector<Key>, std::string>> cases = {
      {{}, ""},
      {{{2048, 0, 1, 4258}}, "EPSG:4258"},
      {{{2048, 0, 1, 4258}, {3072, 0, 1, 25832}}, "EPSG:25832"},
      {{{1024, 0, 1, 1}, {3072, 0, 1, 25832}, {4096, 0, 1, 7837}}, "EPSG:25832+7837"},
      {{{3072, 34736, 1, 5}}, ""},  // its value is elsewhere
      {{{4096, 0, 1, 7837}}, ""},
      // A vertical code that is no system of EPSG leaves the horizontal system.
      {{{1024, 0, 1, 1}, {3072, 0, 1, 26913}, {4096, 0, 1, 5103}}, "EPSG:26913"},
      // A projected system without a code is not the geographic one that it rests on.
      {{{2048, 0, 1, 4258}, {3072, 0, 1, 32767}}, ""},
      {{{1024, 0, 1, 1}, {2048, 0, 1, 4258}}, ""},
      {{{1024, 0, 1, 2}, {2048, 0, 1, 4258}, {3072, 0, 1, 32767}}, "EPSG:4258"}};
  for (const auto& [keys, system] : cases) CHECK(crs_of_keys(keys) == system);
}

TEST_CASE("GeoTIFF keys and well-known text say whether positions are longitude and latitude") {
  const auto is_geographic = [](const std::vector<Key>& keys, const std::string& text = "") {
    LasCrs crs;
    take(crs, 34735, las_geo_keys(keys));
    if (!text.empty()) take(crs, 2112, text);
    return crs.is_geographic();
  };
  CHECK_FALSE(is_geographic({}));
  CHECK(is_geographic({{1024, 0, 1, 2}, {2048, 0, 1, 4326}}));
  CHECK(is_geographic({{1024, 0, 1, 2}, {2048, 0, 1, 32767}}));  // without a code
  CHECK(is_geographic({{2048, 0, 1, 4326}}));                    // without a model
  CHECK_FALSE(is_geographic({{1024, 0, 1, 1}, {2048, 0, 1, 4258}, {3072, 0, 1, 25832}}));
  CHECK_FALSE(is_geographic({{1024, 0, 1, 1}, {2048, 0, 1, 4258}, {3072, 0, 1, 32767}}));
  CHECK_FALSE(is_geographic({{2048, 0, 1, 4258}, {3072, 0, 1, 25832}}));
  CHECK_FALSE(is_geographic({{1024, 0, 1, 3}, {2048, 0, 1, 4978}}));  // geocentric
  CHECK(is_geographic({{1024, 0, 1, 1}, {3072, 0, 1, 25832}}, "GEOGCS[\"WGS 84\"]"));
  CHECK_FALSE(is_geographic({{1024, 0, 1, 2}, {2048, 0, 1, 4326}}, "PROJCS[\"a\",GEOGCS[\"b\"]]"));
}

TEST_CASE("a geocentric system is in metres, and is not the geographic one that names its datum") {
  LasCrs crs;
  take(crs, 34735, las_geo_keys({{1024, 0, 1, 3}, {2048, 0, 1, 4326}}));
  CHECK(crs.text() == "EPSG:4978");
  CHECK(crs.length_unit() == "m");
  CHECK_FALSE(crs.is_geographic());
}

TEST_CASE("keys and well-known text state the unit of z") {
  LasCrs keys, text;
  take(keys, 34735, las_geo_keys({{3072, 0, 1, 26913}, {3076, 0, 1, 9001}, {4099, 0, 1, 9003}}));
  CHECK(keys.length_unit() == "m");
  CHECK(keys.vertical_unit() == "us-ft");
  take(text, 2112, "COMPD_CS[\"a\",PROJCS[\"b\",UNIT[\"metre\",1]],VERT_CS[\"c\",UNIT[\"foot\",0.3048]]]");
  CHECK(text.length_unit() == "m");
  CHECK(text.vertical_unit() == "ft");
}

TEST_CASE("the size of a unit without a code is among the doubles of the keys, in any order") {
  const double sizes[] = {6378137, 1200. / 3937};
  const std::string doubles(reinterpret_cast<const char*>(sizes), sizeof sizes);
  const std::string keys = las_geo_keys({{3072, 0, 1, 32767}, {3076, 0, 1, 32767}, {3077, 34736, 1, 1}});
  LasCrs first, last;
  take(first, 34736, doubles);
  take(first, 34735, keys);
  take(last, 34735, keys);
  CHECK(last.length_unit().empty());
  take(last, 34736, doubles.substr(0, 12));  // cut
  CHECK(last.length_unit().empty());
  take(last, 34736, doubles);
  CHECK(first.length_unit() == "us-ft");
  CHECK(last.length_unit() == "us-ft");
}

TEST_CASE("a unit of the keys that well-known text contradicts is the other unit") {
  LasCrs crs;
  take(crs, 34735, las_geo_keys({{3072, 0, 1, 25832}, {3076, 0, 1, 9003}}));
  CHECK(crs.other_unit().empty());
  take(crs, 2112, "PROJCS[\"b\",UNIT[\"metre\",1]]");
  CHECK(crs.length_unit() == "m");
  CHECK(crs.other_unit() == "us-ft");
}

TEST_CASE("well-known text counts over keys, up to its first zero") {
  LasCrs crs;
  take(crs, 2112, std::string("PROJCS[\"A\"]\0\0", 13));
  take(crs, 34735, las_geo_keys({{3072, 0, 1, 25832}}));
  CHECK(crs.text() == "PROJCS[\"A\"]");
}

TEST_CASE("the header's bit decides between keys and well-known text of two systems") {
  const auto crs_of = [](std::uint16_t code, const std::string& text, bool has_text_bit) {
    LasCrs crs;
    take(crs, 34735, las_geo_keys({{3072, 0, 1, code}, {3076, 0, 1, 9003}}));
    if (!text.empty()) take(crs, 2112, text);
    crs.choose(has_text_bit);
    return crs;
  };
  for (const std::string text : {"PROJCS[\"b\",UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"25833\"]]",
                                 "PROJCRS[\"b\",LENGTHUNIT[\"metre\",1],ID[\"EPSG\", 25833]]"}) {
    const LasCrs keys = crs_of(25832, text, false), of_text = crs_of(25832, text, true);
    CHECK(keys.text() == "EPSG:25832");
    CHECK(keys.other_text() == text);
    CHECK(keys.length_unit() == "us-ft");
    CHECK(keys.other_unit() == "m");
    CHECK(of_text.text() == text);
    CHECK(of_text.other_text() == "EPSG:25832");
    CHECK(of_text.length_unit() == "m");
    for (const bool has_text_bit : {false, true}) {
      const LasCrs same = crs_of(25833, text, has_text_bit);  // the text says more than the code
      CHECK(same.text() == text);
      CHECK(same.other_text().empty());
    }
  }
  CHECK(crs_of(25832, "", true).text() == "EPSG:25832");
  CHECK(crs_of(32767, "PROJCS[\"b\"]", false).text() == "PROJCS[\"b\"]");  // keys without a code
}

TEST_CASE("keys that are cut are passed over") {
  const std::string keys = las_geo_keys({{3072, 0, 1, 25832}, {4096, 0, 1, 7837}});
  for (std::size_t length = 0; length < keys.size(); ++length) {
    LasCrs crs;
    take(crs, 34735, keys.substr(0, length));
    CHECK(crs.text() == (length < 16 ? "" : "EPSG:25832"));
  }
}

}  // namespace lacuna::test
