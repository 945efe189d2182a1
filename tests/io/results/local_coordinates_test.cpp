// SPDX-License-Identifier: Apache-2.0
// PLY files with coordinates relative to an offset, written and read.
#include "io/write/results/points.hpp"
#include "io/write/results/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/json.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

using Point = Eigen::Vector3d;
using Points = std::vector<Point>;

constexpr const char* kOffset = "lacuna offset 500050 5400040 300";

// At UTM, to the last digit of a double. The middle of their bounds is 500049.9 5400039.6 299.8.
Points utm_points() {
  Points points;
  for (int i = 0; i < 100; ++i) points.push_back({500'000.1 + i, 5'400'000.2 + i % 80, 300.3 - 0.01 * i});
  return points;
}

// A run whose loop, sample and boundary have these points.
FakeDetection detection_of(const Points& points) {
  FakeDetection detection;
  detection.with_results(points.size()).with_loop({0, 1, 2}, LoopKind::kHole);
  for (std::size_t i = 0; i < points.size(); ++i) {
    detection.numbers.bounds.extend(points[i]);
    if (i < 3) move_to(detection.found[0][i], points[i]);
    detection.boundary.push_back({ScanPoint::at(points[i], PointId{i}), 0.5f, -1});
    detection.sample.push_back({ScanPoint::at(points[i], PointId{i}), 0.5f, {0, 0, 1}});
  }
  detection.numbers.counts.boundary_points = points.size();
  detection.numbers.strays.rest = detection.numbers.bounds;
  return detection;
}

// The first three floats of each row behind a header, as other programs read them.
Points raw_floats(const std::string& file, const std::string& end_of_header, std::size_t rows,
                  std::size_t row_bytes) {
  const std::size_t begin = file.find(end_of_header) + end_of_header.size();
  Points points;
  for (std::size_t row = begin; points.size() < rows; row += row_bytes)
    points.push_back({at<float>(file, row), at<float>(file, row + 4), at<float>(file, row + 8)});
  return points;
}

// Half of the step of floats below 64.
constexpr double kRounding = 0x1p-19;

void check_near(const Points& points, const Points& expected, double rounding) {
  REQUIRE(points.size() <= expected.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    REQUIRE((points[i] - expected[i]).cwiseAbs().maxCoeff() <= rounding);
}

Points read_points(const fs::path& file) {
  Points points;
  for (const auto& row : read_table(file).rows) points.push_back({row[0], row[1], row[2]});
  return points;
}

}  // namespace

TEST_CASE("with local coordinates, floats and the offset of a header are the coordinates of the scan",
          "[io][results]") {
  const ScratchFolder folder;
  const Points points = utm_points();
  const auto detection = detection_of(points);
  const Point offset(500'050, 5'400'040, 300);
  Points local = points;
  for (Point& point : local) point -= offset;
  const ScanFiles scan({folder.write("a.txt", Cloud{points, {}}.text())}, {});
  FilesConfig config = with_points(PointsFormat::kPly);
  config.output.local_coordinates = true;
  write_results(detection, scan, config, folder / "ply");

  // Their rows are those of floats: 12 bytes for x y z.
  const std::vector<std::pair<std::string, std::size_t>> files = {{"loops.ply", 12 + 8 + 1 + 4 + 3},
                                                                  {"boundary.ply", 12 + 16},
                                                                  {"sample.ply", 12 + 20},
                                                                  {"points.ply", 12 + 16 + 2 + 4 + 4}};
  for (const auto& [name, row_bytes] : files) {
    INFO(name);
    const std::string file = read_file(folder / "ply" / name);
    CHECK_THAT(file.substr(0, 200),
               Contains(std::string("comment lacuna detect\ncomment ") + kOffset + "\nelement vertex ") &&
                   Contains("property float x\nproperty float y\nproperty float z\n"));
    const std::size_t rows = name == "loops.ply" ? 3 : 100;
    check_near(raw_floats(file, "end_header\n", rows, row_bytes), local, kRounding);
    check_near(read_points(folder / "ply" / name), points, kRounding);
  }
  const auto json = json_of(read_file(folder / "ply" / "holes.json"));
  CHECK(json.at("offset") == nlohmann::json{500'050, 5'400'040, 300});
  CHECK(json.at("loops")[0].at("coordinates")[1] ==
        nlohmann::json{points[1].x(), points[1].y(), points[1].z()});
}

TEST_CASE("the offset is the middle of the scan without its strays in whole units, 0 without points",
          "[io]") {
  OutputConfig config;
  FakeDetection detection;
  CHECK_FALSE(local_offset(detection, config));
  config.local_coordinates = true;
  CHECK(*local_offset(detection, config) == Point(0, 0, 0));
  detection.numbers.bounds = {Point(-1e6, -2, 0), Point(500'000, 5'400'000, 7)};
  detection.numbers.strays.rest = {Point(400'000, -2, -0.25), Point(500'001, 1.5, 0)};
  const Point offset = *local_offset(detection, config);
  CHECK(offset == Point(450'001, 0, 0));
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

}  // namespace lacuna::test
