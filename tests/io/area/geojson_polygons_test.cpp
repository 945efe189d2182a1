// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/area_polygons.hpp"
#include "tests/io/io_support.hpp"

namespace lacuna::io {
namespace {

constexpr std::uint64_t kMemory = 1 << 20;

HeldPolygons read(const std::string& text, std::uint64_t memory = kMemory) {
  const ScratchFolder folder;
  HeldPolygons polygons{.file = folder.write("a.json", text), .memory = memory};
  REQUIRE(looks_like_geojson(polygons.file));
  read_geojson_polygons(polygons);
  return polygons;
}

// Polygons by their rings' numbers of corners.
std::string shapes(const std::string& text) {
  std::string all;
  for (const PlanPolygon& polygon : read(text).polygons) {
    all += all.empty() ? "" : ", ";
    for (const Ring2& ring : polygon)
      all += (&ring == &polygon.front() ? "" : " ") + std::to_string(ring.size());
  }
  return all;
}

const std::string kRing = "[[0, 0, 5], [4, 0], [4.5, 4], [0, 4], [0, 0]]",
                  kTriangle = "[[1, 1], [2, 1], [1, 2]]";
const std::string kPolygon = R"({"coordinates": [)" + kRing + ", " + kTriangle + R"(], "type": "Polygon"})";

TEST_CASE("the polygons of GeoJSON are those of all geometries, in whatever order their members are",
          "[io][area]") {
  CHECK(shapes(kPolygon) == "4 3");
  CHECK(read(kPolygon).polygons[0][0][2] == Eigen::Vector2d(4.5, 4));
  const std::string several =
      R"({"type": "MultiPolygon", "coordinates": [[)" + kRing + "], [" + kTriangle + ", " + kRing + "]]}";
  CHECK(shapes(several) == "4, 3 4");
  const auto feature = [](const std::string& geometry) {
    return R"({"properties": {"coordinates": [[[1]]], "geometry": {"type": "Polygon", "coordinates": [)" +
           kRing + R"(]}}, "geometry": )" + geometry + R"(, "type": "Feature", "more": [[[[0, 1]]]]})";
  };
  CHECK(shapes(feature("null")).empty());
  CHECK(shapes(feature(kPolygon)) == "4 3");
  const std::string lines = R"({"type": "MultiLineString", "coordinates": [)" + kRing + "]}",
                    point = R"({"coordinates": [1, 2], "type": "Point"})",
                    empty = R"({"type": "Polygon", "coordinates": []})";
  const std::string collection = R"({"type": "GeometryCollection", "geometries": [)" + lines + "," +
                                 kPolygon + "," + point + "," + several + "," + empty + "]}";
  CHECK(shapes(R"({"features": [)" + feature(collection) + "," + feature(lines) + "," + feature(kPolygon) +
               R"(], "type": "FeatureCollection"})") == "4 3, 4, 3 4, 4 3");
}

TEST_CASE("GeoJSON is in longitude and latitude, unless its member crs names a system", "[io][area]") {
  const auto crs_of = [](const std::string& crs) {
    return read(R"({"type": "Feature", )" + crs + R"( "geometry": )" + kPolygon + "}").file_crs;
  };
  CHECK(crs_of("") == "EPSG:4326");
  CHECK(crs_of(R"("crs": null,)").empty());
  CHECK(crs_of(R"("crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}},)") ==
        "urn:ogc:def:crs:EPSG::25832");
  CHECK_THROWS_WITH(crs_of(R"("crs": {"type": "link", "properties": {"href": "x"}},)"),
                    Contains("its member crs has no name"));
}

TEST_CASE("GeoJSON that is none, and more corners than the memory allows, are errors that name them",
          "[io][area]") {
  const auto polygon = [](const std::string& coordinates) {
    return R"({"type": "Polygon", "coordinates": )" + coordinates + "}";
  };
  for (const auto& [text, reason] :
       {std::pair<std::string, const char*>{"{}", "has no type of GeoJSON"},
        {"{", "is not JSON; GeoJSON with polygons is needed"},
        {R"({"type": "Topology"})", "has no type of GeoJSON"},
        {polygon("[[[0, 0], [1, 0], [1]]]"), "has a corner of less than two numbers"},
        {polygon("[[[0, 0], [1, \"a\"]]]"), "has a corner that is no list of numbers"},
        {polygon("[[[0, 0], [[1, 1]]]]"), "coordinates that are nested unevenly"},
        {polygon("[[[[0, 0], [1, 1], [1, 0]]]]"), "has a Polygon whose coordinates are nested otherwise"},
        {polygon(std::string(99, '[')), "nested deeper"}}) {
    INFO(text);
    CHECK_THROWS_WITH(read(text), Contains("a.json: ") && Contains(reason));
  }
  std::string many = "[[";
  for (int i = 0; i < 14000; ++i) many += "[" + std::to_string(i) + ", 0], ";
  CHECK_THROWS_WITH(read(polygon(many + "[0, 9]]]")),
                    Contains("13108 corners of polygons, 13108 of them in one, take more than the 1 MiB") &&
                        Contains("allowed: 13107 in one, or a higher limit"));
  CHECK(read(polygon(many + "[0, 9]]]"), 2 * kMemory).corners == 14001);
}

}  // namespace
}  // namespace lacuna::io
