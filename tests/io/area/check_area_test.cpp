// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/area_polygons.hpp"
#include "io/explain/area/empty_places.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> heights;
  for (int i = 0; i < count; ++i) heights.push_back(from + (to - from) * i / (count - 1));
  return heights;
}

std::vector<double> joined(std::vector<double> heights, const std::vector<double>& more) {
  heights.insert(heights.end(), more.begin(), more.end());
  return heights;
}

// The number of heights that lie apart.
std::uint64_t apart(std::vector<double> heights) {
  std::mt19937 random(1);
  HeightGroups groups(100);
  std::ranges::shuffle(heights, random);
  for (const double height : heights) groups.add(height);
  std::uint64_t count = 0;
  for (const HeightGroup& group : groups.parts().apart) count += group.points;
  return count;
}

TEST_CASE("no-data values, clouds and stray returns lie apart from the ground", "[io][area]") {
  const std::vector<double> ground = evenly(300, 360, 1000);
  for (const double value : {-9999., -32768., -3.4028234663852886e38, 99999., 1e30, 0., -1.}) {
    CHECK(apart(joined(ground, std::vector<double>(40, value))) == 40);
    CHECK(apart(joined(ground, std::vector<double>(4000, value))) == 4000);  // more than the ground has
  }
  CHECK(apart(joined(ground, evenly(1480, 1520, 40))) == 40);
  CHECK(apart(joined(joined(ground, evenly(-400, 100, 20)), {900})) == 21);
  CHECK(apart(joined(std::vector<double>(1000, 12), evenly(1480, 1520, 40))) == 40);  // water alone
  CHECK(apart(joined(evenly(-900, 900, 3000), std::vector<double>(9, -9999))) == 9);
}

TEST_CASE("steep ground, trees, towers, bridges and two terraces are ground", "[io][area]") {
  const std::vector<double> ground = evenly(0, 5, 1000);
  CHECK(apart({}) == 0);
  CHECK(apart({7}) == 0);
  CHECK(apart(evenly(0, 3000, 1000)) == 0);
  CHECK(apart(joined(ground, evenly(20, 45, 30))) == 0);
  CHECK(apart(joined(ground, std::vector<double>(30, 90))) == 0);
  CHECK(apart(joined(ground, evenly(0, 340, 10))) == 0);
  CHECK(apart(joined(ground, evenly(800, 810, 400))) == 0);
}

TEST_CASE("a point that two files round differently is one, and near points of other times are not",
          "[io][area]") {
  constexpr double kStep = 0.01;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 50);
  RepeatedPoints repeated({.with_time = 1.1 * kStep, .without_time = 1.1 * kStep}, 1 << 20);
  constexpr int kPoints = 2500;
  int again = 0;
  for (int i = 0; i < 2 * kPoints; ++i) {
    const Eigen::Vector3d at(place(random), place(random), place(random));
    const double time = i % 2 * (1 + i);  // half have none
    const Eigen::Vector3d first = (at.array() / kStep).round() * kStep;
    const Eigen::Vector3d second = ((at.array() - kStep / 2) / kStep).round() * kStep + kStep / 2;
    CHECK_FALSE(repeated.add(first, time));
    CHECK(repeated.add(first, time));
    again += repeated.add(second, time);
    if (time > 0) CHECK_FALSE(repeated.add(first, time + 0.5));
  }
  CHECK(again == kPoints);
  CHECK(repeated.count() == 3 * kPoints);
  CHECK(repeated.near() == kPoints);  // without times they may be there by chance
  CHECK_FALSE(repeated.add({60, 60, 60}, 7));
  CHECK_FALSE(repeated.add({60, 60, 60 + 3 * kStep}, 7));
}

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

TEST_CASE("the polygons of all geometries of GeoJSON are read, in whatever order their members are",
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

// ---- Rasters. area_test.sh compares their cells with a plain reference.

Eigen::Vector2d middle(std::size_t column, std::size_t row) {
  return {static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5};
}

PlanGrid grid_of(std::size_t columns, std::size_t rows) {
  return {.size = PlanGrid::kCells, .columns = columns, .rows = rows};
}

// Counts the edges that a ray to the east crosses.
bool is_inside(const PlanPolygon& polygon, const Eigen::Vector2d& place) {
  bool inside = false;
  for (const Ring2& ring : polygon) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() <= place.y()) == (b.y() <= place.y())) continue;
      inside ^= a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > place.x();
    }
  }
  return inside;
}

TEST_CASE("a polygon that crosses rows very often has the same cells, in rows one after the other") {
  const PlanGrid grid = grid_of(400, 1500);
  Ring2 comb;  // up and down within each two columns
  for (int i = 0; i < 100; ++i) {
    comb.emplace_back(4 * i, 0);
    comb.emplace_back(4 * i + 1, 1500);
    comb.emplace_back(4 * i + 2, 1500);
    comb.emplace_back(4 * i + 3, 2);
  }
  const PlanPolygon polygon{comb};
  std::size_t last = 0;
  std::vector<std::uint64_t> cells(grid.rows);
  for_each_run(polygon, Frame::kCells, grid, [&](std::size_t row, std::size_t from, std::size_t to) {
    REQUIRE(row >= last);
    last = row;
    cells[row] += to - from;
  });
  for (std::size_t row = 0; row < grid.rows; row += 7) {
    std::uint64_t expected = 0;
    for (std::size_t column = 0; column < grid.columns; ++column)
      expected += is_inside(polygon, middle(column, row));
    REQUIRE(cells[row] == expected);
  }
}

TEST_CASE("squares of the table are whole multiples of their edge, and sum up their cells") {
  PlanGrid grid = grid_of(30, 20);
  grid.first = {-5, 13};  // from -5 to 25, and from 13 to 33
  PlanRaster inside(grid);
  for (std::size_t row = 0; row < grid.rows; ++row) inside.set(row, 0, 28);
  AreaTiles tiles(20, grid);
  tiles.add_area(inside);
  tiles.add_void_cells(2, 3, 8);
  tiles.add_point(6, 6);
  tiles.add_void(6, 7);
  const std::vector<AreaTile> all = tiles.with_area();
  REQUIRE(all.size() == 6);
  CHECK(all[0].corner == Eigen::Vector2d(-20, 0));
  CHECK(all[0].area == 5 * 7);
  CHECK(all[0].voids_area == 2);
  CHECK(all[1].corner == Eigen::Vector2d(0, 0));
  CHECK(all[1].voids_area == 3);
  CHECK(all[1].points == 1);
  CHECK(all[4].corner == Eigen::Vector2d(0, 20));
  CHECK(all[4].voids == 1);
  CHECK(all[5].area == 3 * 13);
  CHECK(AreaTiles(0, grid).with_area().empty());
}

TEST_CASE("the spacing around an outline is of the points near it") {
  const PlanGrid grid = grid_of(200, 200);
  PlanRaster inside(grid);
  inside.fill();
  PointDensity density(grid);
  for (std::size_t row = 0; row < grid.rows; row += 2) {
    for (std::size_t column = 0; column < grid.columns; column += 2) {
      const bool is_empty = row >= 80 && row < 120 && column >= 80 && column < 120;
      const bool is_far = row < 48 || column < 48;  // denser there
      for (int i = 0; i < (is_far ? 5 : is_empty ? 0 : 1); ++i) density.add(column, row);
    }
  }
  const Ring2 outline{{80, 80}, {80, 120}, {120, 120}, {120, 80}};
  CHECK(density.spacing_around({outline}, inside) == Approx(2));
  CHECK(std::isnan(PointDensity(grid).spacing_around({outline}, inside)));
}

}  // namespace

}  // namespace lacuna::io
