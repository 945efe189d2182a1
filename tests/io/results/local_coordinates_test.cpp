// SPDX-License-Identifier: Apache-2.0
// PLY and PCD files with coordinates relative to an offset, written and read.
#include "io/results/local_coordinates.hpp"

#include "io/results/points.hpp"
#include "io/results/result_bytes.hpp"
#include "io/results/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace lacuna::test {
using namespace io;

namespace {

using Catch::Matchers::Contains;
using Point = Eigen::Vector3d;
using Points = std::vector<Point>;

constexpr const char* kOffset = "lacuna offset 500050 5400040 300";

// At UTM, to the last digit of a double. The middle of their bounds is 500049.9 5400039.6 299.8.
Points utm_points() {
  Points points;
  for (int i = 0; i < 100; ++i) points.push_back({500'000.1 + i, 5'400'000.2 + i % 80, 300.3 - 0.01 * i});
  return points;
}

std::string text_of(const Points& points) {
  std::ostringstream text;
  text.precision(17);
  for (const Point& p : points) text << p.transpose() << "\n";
  return text.str();
}

// A run whose loop, sample and boundary have these points.
FakeDetection detection_of(const Points& points) {
  FakeDetection detection;
  detection.with_results(points.size()).with_loop({0, 1, 2}, LoopKind::kHole);
  for (std::size_t i = 0; i < points.size(); ++i) {
    detection.numbers.bounds.extend(points[i]);
    if (i < 3) detection.found[0][i].position = points[i];
    detection.boundary.push_back({.id = PointId{i}, .position = points[i], .probability = 0.5f, .loop = -1});
    detection.sample.push_back(
        {.id = PointId{i}, .position = points[i], .probability = 0.5f, .normal = {0, 0, 1}});
  }
  detection.numbers.counts.boundary_points = points.size();
  detection.numbers.strays.rest = detection.numbers.bounds;
  return detection;
}

FilesConfig local_config(PointsFormat format) {
  FilesConfig config;
  config.results.points = true;
  config.output.points_format = format;
  config.output.local_coordinates = true;
  return config;
}

// The first three floats of each row behind a header, as other programs read them.
Points raw_floats(const std::string& file, const std::string& end_of_header, std::size_t rows,
                  std::size_t row_bytes) {
  const std::size_t begin = file.find(end_of_header) + end_of_header.size();
  Points points;
  for (std::size_t row = 0; row < rows; ++row) {
    std::array<float, 3> values;
    std::memcpy(values.data(), &file.at(begin + row * row_bytes), sizeof values);
    points.push_back({values[0], values[1], values[2]});
  }
  return points;
}

// Half of the step of floats below 64.
constexpr double kRounding = 0x1p-19;

void check_near(const Points& points, const Points& expected, double rounding) {
  REQUIRE(points.size() <= expected.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    REQUIRE((points[i] - expected[i]).cwiseAbs().maxCoeff() <= rounding);
}

Points read_points(const std::filesystem::path& file) {
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
  FileScan scan({folder.write("a.txt", text_of(points))}, {});
  write_results(detection, scan, local_config(PointsFormat::kPly), folder / "ply");
  write_results(detection, scan, local_config(PointsFormat::kPcd), folder / "pcd");

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
  const std::string pcd = read_file(folder / "pcd" / "points.pcd");
  CHECK_THAT(pcd,
             Contains(std::string("# .PCD v0.7 - written by Lacuna\n# ") + kOffset + "\nVERSION 0.7\n") &&
                 Contains("\nSIZE 4 4 4 "));
  check_near(raw_floats(pcd, "DATA binary\n", 100, 12 + 16 + 2 + 4), local, kRounding);
  check_near(read_points(folder / "pcd" / "points.pcd"), points, kRounding);
  const auto json = nlohmann::json::parse(read_file(folder / "pcd" / "holes.json"));
  CHECK(json.at("offset") == nlohmann::json{500'050, 5'400'040, 300});
  CHECK(json.at("loops")[0].at("coordinates")[1] ==
        nlohmann::json{points[1].x(), points[1].y(), points[1].z()});
  for (const PointsFormat format : {PointsFormat::kPly, PointsFormat::kPcd}) {
    const FilesConfig config = local_config(format);
    const auto size = std::filesystem::file_size(
        folder / (format == PointsFormat::kPly ? "ply/points.ply" : "pcd/points.pcd"));
    const auto bytes = result_bytes(scan, config, 100, 100);
    CHECK(bytes.points <= size);
    CHECK(bytes.points + 1000 >= size);  // with a header
    CHECK(bytes.sample == 100 * 32);
  }
}

TEST_CASE("without local coordinates nothing states an offset, and coordinates are doubles",
          "[io][results]") {
  const ScratchFolder folder;
  const Points points = utm_points();
  FileScan scan({folder.write("a.txt", text_of(points))}, {});
  FilesConfig config = local_config(PointsFormat::kPly);
  config.output.local_coordinates = false;
  write_results(detection_of(points), scan, config, folder.path());
  for (const char* name : {"loops.ply", "boundary.ply", "sample.ply", "points.ply"}) {
    const std::string file = read_file(folder / name);
    CHECK_THAT(file.substr(0, 300), Contains("comment lacuna detect\nelement vertex ") &&
                                        Contains("property double x\n") && !Contains("offset"));
    check_near(read_points(folder / name), points, 0);
  }
  CHECK(nlohmann::json::parse(read_file(folder / "holes.json")).at("offset").is_null());
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
      "ply\nformat ascii 1.0\ncomment lacuna offset 500000 -2.5 1e3\nelement vertex 2\nproperty float nx\n"
      "property uchar X\nproperty float y\nproperty double z\nproperty float quality\nend_header\n"
      "1 2 0.5 3 4\n5 6 nan 7 8\n";
  const Table table = read_table(folder.write("a.ply", ply), 1);
  CHECK(table.names == std::vector<std::string>{"nx", "x", "y", "z", "quality"});
  CHECK(table.rows[0] == std::vector<double>{1, 500'002, -2, 1003, 4});
  CHECK(table.rows[1][1] == 500'006);
  CHECK(std::isnan(table.rows[1][2]));
  CHECK(table.rows[1][3] == 1007);
  const std::string pcd =
      "# .PCD v0.7\n# lacuna offset 500000 -2.5 1e3\nVERSION .7\nFIELDS intensity x y z\nSIZE 4 4 4 8\nTYPE "
      "F F I "
      "F\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 1\nDATA ascii\n9 0.5 1 2\n";
  const auto reader = open_scan(folder.write("a.pcd", pcd), {});
  CHECK(reader->no_return_places() == Points{Point(0, 0, 0), Point(500'001, -0.5, 1003)});
  REQUIRE(reader->scanners().size() == 1);
  CHECK(reader->scanners()[0].place == Point(500'001, -0.5, 1003));
  std::string unknown = pcd;
  unknown.replace(unknown.find("VIEWPOINT 1 2 3"), 15, "VIEWPOINT 0 0 0");
  CHECK(open_scan(folder.write("unknown.pcd", unknown), {})->no_return_places() == Points{Point(0, 0, 0)});
  CHECK(read_table(folder / "a.pcd").rows[0] == std::vector<double>{9, 500'000.5, -1.5, 1002});
}

TEST_CASE("an offset that is not three finite numbers, or a second one, is an error with its line", "[io]") {
  const ScratchFolder folder;
  const auto error_with = [&](const std::string& comment) {
    const std::string ply = read_error(folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\ncomment " + comment +
            "\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n"));
    const std::string pcd = read_error(folder.write(
        "a.pcd", "# .PCD v0.7\nVERSION .7\n# " + comment + "\nFIELDS x y z\nWIDTH 1\nDATA ascii\n1 2 3\n"));
    CHECK(ply.empty() == pcd.empty());
    CHECK((ply.empty() || (ply.find("a.ply: line ") != ply.npos && pcd.find("a.pcd: line ") != pcd.npos)));
    return ply;
  };
  for (const char* wrong : {"lacuna offset", "lacuna offset 1 2", "lacuna offset 1 2 3 4",
                            "lacuna offset 1 2 x", "lacuna offset 1 2 nan", "lacuna offset inf 2 3"}) {
    CHECK_THAT(error_with(wrong), Contains("line 3: 'lacuna offset X Y Z' with three numbers expected"));
  }
  for (const char* other : {"offset 1 2", "lacuna", "lacuna detect", "lacuna offsets", "lacuna offset 1 2 3"})
    CHECK(error_with(other).empty());
  CHECK_THAT(read_error(folder.write("b.ply",
                                     "ply\nformat ascii 1.0\ncomment lacuna offset 1 2 3\ncomment lacuna "
                                     "offset 1 2 3\nelement vertex 0\nend_header\n")),
             Contains("line 4: a second 'lacuna offset'"));
}

TEST_CASE("points.pcd of PCD files keeps all but their positions, whatever offsets the files have",
          "[io][results]") {
  const ScratchFolder folder;
  const std::string fields =
      "FIELDS hist x _ y z rgb\nSIZE 2 8 1 8 8 4\nTYPE I F U F F F\nCOUNT 2 1 3 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 500001.5 5400002 300 0.5 0.5 0.5 0.5\nPOINTS 2\nDATA binary\n";
  const Points points = {{500'000.25, 5'400'000.5, 300.75}, {500'010.25, 5'400'020.5, 310.75}};
  Bytes rows;
  for (const Point& p : points)
    rows << std::int16_t{-1} << std::int16_t{5} << p.x() << std::uint8_t{1} << std::uint16_t{2} << p.y()
         << p.z() << std::uint32_t{0xff010203u};
  const auto real = folder.write("real.pcd", "VERSION .7\n" + fields + rows.str());
  const auto write = [&](const std::vector<ScanInput>& inputs, bool is_local, const std::string& name) {
    FileScan scan(inputs, {});
    Points all;
    for (std::size_t i = 0; i < inputs.size(); ++i) all.insert(all.end(), points.begin(), points.end());
    FilesConfig config = local_config(PointsFormat::kPcd);
    config.output.local_coordinates = is_local;
    write_results(detection_of(all), scan, config, folder / name);
    return read_file(folder / name / "points.pcd");
  };
  // These local coordinates are floats without any rounding.
  const std::string local = write({real}, true, "local");
  CHECK_THAT(local, Contains("# lacuna offset 500005 5400011 306\n") &&
                        Contains("FIELDS hist x y z rgb scalar_") && Contains("\nSIZE 2 4 4 4 4 4") &&
                        Contains("\nVIEWPOINT -3.5 -9 -6 0.5 0.5 0.5 0.5\n"));
  const auto check_points = [&](const std::string& name, std::size_t copies) {
    const Table table = read_table(folder / name / "points.pcd");
    REQUIRE(table.rows.size() == 2 * copies);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const auto& row = table.rows[i];
      CHECK(Point(row[2], row[3], row[4]) == points[i % 2]);
      CHECK(std::vector<double>(row.begin(), row.begin() + 2) == std::vector<double>{-1, 5});
      CHECK(std::vector<double>(row.begin() + 5, row.begin() + 8) == std::vector<double>{1, 2, 3});
    }
  };
  check_points("local", 1);

  // Again with an offset, the bytes are the same. Without, they are those of the scan in doubles.
  const auto first = folder.write("first.pcd", local);
  CHECK((write({first}, true, "again") == local));
  const std::string doubles = write({first}, false, "doubles");
  CHECK((doubles == write({real}, false, "plain")));
  check_points("doubles", 1);
  // An unknown scanner stays unknown.
  std::string unknown = "VERSION .7\n" + fields + rows.str();
  unknown.replace(unknown.find("500001.5 5400002 300"), 20, "0 0 0");
  CHECK_THAT(write({folder.write("unknown.pcd", unknown)}, true, "unknown"),
             Contains("\nVIEWPOINT 0 0 0 0.5 0.5 0.5 0.5\n"));
  // Two files with another offset each.
  std::string shifted = local;
  shifted.replace(shifted.find("lacuna offset 500005"), 20, "lacuna offset 500004");
  const auto other = folder.write("other.pcd", shifted);
  write({first, other}, true, "both");
  const Table both = read_table(folder / "both" / "points.pcd");
  REQUIRE(both.rows.size() == 4);
  CHECK(both.rows[2][2] == both.rows[0][2] - 1);
  CHECK(both.rows[2][3] == both.rows[0][3]);
}

}  // namespace lacuna::test
