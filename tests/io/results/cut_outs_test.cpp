// SPDX-License-Identifier: Apache-2.0
// Cut-outs of loops that the tests draw.
#include "io/results/cut_outs.hpp"

#include "io/results/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/las/las_file.hpp"
#include "tests/io/results/fake_detection.hpp"

#include <cmath>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace io;

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

constexpr double kMargin = 0.75;

FilesConfig with_cut_outs(PointsFormat format = PointsFormat::kInput) {
  FilesConfig config;
  config.output.cut_outs = kMargin;
  config.output.points_format = format;
  return config;
}

// Squares with an edge of 2 around these places, which is where the points of the tests lie.
FakeDetection with_squares(std::size_t count, LoopKind kind = LoopKind::kHole) {
  FakeDetection detection;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 10);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = place(random), y = place(random);
    Loop loop;
    for (const auto& [dx, dy] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
      loop.push_back({.id = PointId{i}, .position = {x + dx, y + dy, 0.1 * dx}});
    detection.found.push_back(loop);
    detection.measures.push_back({.kind = kind, .points = 4});
  }
  return detection;
}

struct Point {
  double x, y, z;
};

std::vector<Point> random_points(std::size_t count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1, 11), height(-1.5, 1.5);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({place(random), place(random), height(random)});
  return points;
}

std::string text_of(const std::vector<Point>& points) {
  std::ostringstream text;
  text.precision(17);
  text << "x y z scalar_probability quality intensity\n";
  std::size_t i = 0;
  for (const Point& p : points) text << p.x << ' ' << p.y << ' ' << p.z << " 0.5 1 " << ++i << '\n';
  return text.str();
}

// All columns have values, and extra bytes of an earlier run are among them.
LasFile las_of(const std::vector<Point>& points, int format, double offset = 0) {
  LasFile las;
  las.minor = 4;
  las.format = format;
  las.scale = {0.001, 0.001, 0.001};
  las.offset = {offset, offset, 0};
  const std::size_t bytes = format == 6 ? 30 : 28;
  std::mt19937 random(7);
  for (const Point& p : points) {
    const auto stored = [](double value) { return static_cast<std::int32_t>(std::lround(value * 1000)); };
    std::string point = las_point(bytes + 6, stored(p.x), stored(p.y), stored(p.z));
    for (std::size_t b = 12; b < point.size(); ++b) point[b] = static_cast<char>(random() % 64);
    las.points.push_back(point);
  }
  std::string probability = las_extra_descriptor("probability", 9);
  probability.replace(160, 20, "Lacuna: probability ");
  las.records.push_back(las_record("LASF_Spec", 4, probability + las_extra_descriptor("tone", 3)));
  return las;
}

// The rows of the files in the box of the loop, by its index.
Table expected_rows(const std::vector<std::string>& files, const Loop& loop,
                    const Eigen::Vector3d& moved = {0, 0, 0}) {
  Eigen::AlignedBox3d box;
  for (const LoopPoint& point : loop) box.extend(point.position);
  box = {box.min().array() - kMargin, box.max().array() + kMargin};
  Table all;
  for (const std::string& file : files) {
    const Table table = read_table(file);
    all.names = table.names;
    for (std::vector<double> row : table.rows) {
      for (std::size_t axis = 0; axis < 3; ++axis) row[axis] += moved[static_cast<Eigen::Index>(axis)];
      if (box.contains(Eigen::Vector3d(row[0], row[1], row[2]))) all.rows.push_back(row);
    }
  }
  return all;
}

bool is_same(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  const auto is_same_value = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const auto& left, const auto& right) {
    return std::equal(left.begin(), left.end(), right.begin(), right.end(), is_same_value);
  });
}

// Writes only the cut-outs. Returns their folder.
fs::path cut_out(const FakeDetection& detection, const std::vector<ScanInput>& inputs,
                 const FilesConfig& config, const fs::path& out, std::size_t most_holes = 1000) {
  FileScan scan(inputs, {});
  check_cut_outs(scan, config, out, Overwrite::kOwn);
  fs::create_directories(out);
  OutputSet set(Overwrite::kOwn);
  write_cut_outs(detection, scan, config, out, set, most_holes);
  set.commit();
  return out / kCutOutsFolder;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    files[entry.path().filename()] = read_file(entry.path());
  return files;
}

void check_selections(const FakeDetection& detection, const fs::path& cut_outs,
                      const std::vector<std::string>& inputs, const std::string& extension) {
  std::size_t rows = 0;
  for (std::size_t loop = 0; loop < detection.found.size(); ++loop) {
    Table expected = expected_rows(inputs, detection.found[loop]);
    const Table read = read_table(cut_outs / ("hole-" + std::to_string(loop) + extension));
    if (extension == ".csv") {
      expected.names.emplace_back(kCutOutColumn);
      for (auto& row : expected.rows) row.push_back(static_cast<double>(loop));
    }
    CHECK(read.names == expected.names);
    CHECK(is_same(read.rows, expected.rows));
    rows += expected.rows.size();
  }
  CHECK(rows > 100);
}

}  // namespace

TEST_CASE("a cut-out has the rows in the widened box of its loop, with all columns, in each format",
          "[io][results]") {
  const ScratchFolder folder;
  const FakeDetection detection = with_squares(5);
  const std::vector<Point> points = random_points(3000);
  const std::string text = folder.write("scan.xyz", text_of(points) + "nan nan nan 0 0 0\n");
  const std::string las = folder.write("scan.las", las_of(points, 1).bytes());
  check_selections(detection, cut_out(detection, {text}, with_cut_outs(), folder / "text"), {text}, ".csv");
  check_selections(detection, cut_out(detection, {las}, with_cut_outs(), folder / "las"), {las}, ".ply");
  const fs::path ply = cut_out(detection, {text}, with_cut_outs(PointsFormat::kPly), folder / "ply");
  check_selections(detection, ply, {text}, ".ply");
}

TEST_CASE("cut-outs of files that differ in scale, pose and format have the points of all in order",
          "[io][results]") {
  const ScratchFolder folder;
  const FakeDetection detection = with_squares(3);
  const std::string a = folder.write("a.las", las_of(random_points(400, 1), 1).bytes());
  const std::string b = folder.write("b.las", las_of(random_points(400, 2), 1, 5.5).bytes());
  const std::string c = folder.write("c.xyz", text_of(random_points(400, 4)));
  const Eigen::Vector3d moved(-5.5, -5.5, 0);
  Pose pose = Pose::Identity();
  pose.translation() = moved;
  const std::vector<ScanInput> inputs{a, ScanInput(b, pose), c};
  for (const PointsFormat format : {PointsFormat::kInput, PointsFormat::kCsv}) {
    const std::string extension = format == PointsFormat::kInput ? ".ply" : ".csv";
    const fs::path made = cut_out(detection, inputs, with_cut_outs(format), folder / extension);
    for (std::size_t loop = 0; loop < detection.found.size(); ++loop) {
      std::vector<std::vector<double>> expected;
      for (const Table& part :
           {expected_rows({a}, detection.found[loop]), expected_rows({b}, detection.found[loop], moved),
            expected_rows({c}, detection.found[loop])})
        expected.insert(expected.end(), part.rows.begin(), part.rows.end());
      const Table read = read_table(made / ("hole-" + std::to_string(loop) + extension));
      REQUIRE(read.rows.size() == expected.size());
      for (std::size_t row = 0; row < expected.size(); ++row) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          CHECK(read.rows[row][axis] == Approx(expected[row][axis]).margin(2e-7));
      }
    }
  }
}

TEST_CASE("cut-outs of local coordinates are those of the scan", "[io][results]") {
  const ScratchFolder folder;
  FakeDetection detection = with_squares(1);
  detection.numbers.strays.rest = {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(10, 11, 1)};
  const std::string text = folder.write("scan.xyz", text_of(random_points(2000)));
  const std::vector<std::vector<double>> expected = expected_rows({text}, detection.found[0]).rows;
  FilesConfig config = with_cut_outs(PointsFormat::kPly);
  config.output.local_coordinates = true;
  const std::string name = "hole-0.ply";
  const fs::path local = cut_out(detection, {text}, config, folder / "local") / name;
  const std::string bytes = read_file(local);
  CHECK(bytes.find("lacuna offset 5 6 0\n") < bytes.size());
  CHECK(read_table(local).rows.size() == expected.size());
  CHECK(expected.size() > 20);
  // Positions of the file count with the offset.
  const fs::path again = cut_out(detection, {local}, with_cut_outs(), folder / "again") / name;
  CHECK(is_same(read_table(again).rows, read_table(local).rows));
}

TEST_CASE("more holes than a pass takes have the same files", "[io][results]") {
  const ScratchFolder folder;
  const FakeDetection detection = with_squares(23);
  const std::string scan = folder.write("scan.las", las_of(random_points(2000), 1).bytes());
  const auto files = files_of(cut_out(detection, {scan}, with_cut_outs(), folder / "one"));
  CHECK(files.size() == 23);
  for (const std::size_t most : {1u, 5u, 23u})
    CHECK((files_of(cut_out(detection, {scan}, with_cut_outs(), folder / std::to_string(most), most)) ==
           files));
}

TEST_CASE("outer curves have no cut-outs, and without holes there is no folder", "[io][results]") {
  const ScratchFolder folder;
  const std::string scan = folder.write("scan.xyz", text_of(random_points(100)));
  FakeDetection detection = with_squares(3, LoopKind::kOuter);
  CHECK_FALSE(fs::exists(cut_out(detection, {scan}, with_cut_outs(), folder / "out")));
  detection.measures[1].kind = LoopKind::kHole;
  const fs::path made = cut_out(detection, {scan}, with_cut_outs(), folder / "out");
  CHECK(files_of(made).size() == 1);
  CHECK(fs::exists(made / "hole-1.csv"));
  // A hole without points around it has an empty file.
  detection.found[1][0].position.z() = detection.found[1][1].position.z() = 1000;
  for (LoopPoint& point : detection.found[1]) point.position.z() = 1000;
  CHECK(
      read_table(cut_out(detection, {scan}, with_cut_outs(PointsFormat::kPly), folder / "out") / "hole-1.ply")
          .rows.empty());
}

TEST_CASE("cut-outs of earlier runs go, whatever their format, and all other files stay", "[io][results]") {
  const ScratchFolder folder;
  const std::string scan = folder.write("scan.las", las_of(random_points(300), 1).bytes());
  const fs::path out = folder / "out", cut_outs = out / kCutOutsFolder;
  const FakeDetection many = with_squares(12), few = with_squares(2), none;
  for (const PointsFormat format : {PointsFormat::kPly, PointsFormat::kCsv}) {
    cut_out(many, {scan}, with_cut_outs(format), out);
    CHECK(files_of(cut_outs).size() == 12);
  }
  cut_out(few, {scan}, with_cut_outs(PointsFormat::kPly), out);
  CHECK(files_of(cut_outs).size() == 2);
  cut_out(many, {scan}, {}, out);  // without the option
  CHECK_FALSE(fs::exists(cut_outs));

  cut_out(few, {scan}, with_cut_outs(), out);
  const std::map<std::string, std::string> foreign = {
      {"hole-7.csv", "x,y,z\n"},  {"hole-007.ply", read_file(cut_outs / "hole-0.ply")},
      {"hole-1.ply.bak", "mine"}, {"my-hole-1.ply", "mine"},
      {"hole-.ply", "mine"},      {"hole--1.ply", "mine"},
      {"hole-1.txt", "mine"},     {"notes", "mine"}};
  for (const auto& [name, content] : foreign) folder.write("out/cut-outs/" + name, content);
  cut_out(none, {scan}, with_cut_outs(), out);
  CHECK(files_of(cut_outs) == foreign);
  cut_out(many, {scan}, {}, out);
  CHECK(files_of(cut_outs) == foreign);
}

TEST_CASE("an input in the place of a cut-out is refused", "[io][results]") {
  const ScratchFolder folder;
  const std::string scan = folder.write("scan.las", las_of(random_points(300), 1).bytes());
  const fs::path out = folder / "out";
  const std::string input = (cut_out(with_squares(1), {scan}, with_cut_outs(), out) / "hole-0.ply").string();
  for (const FilesConfig& config : {with_cut_outs(), FilesConfig{}})
    CHECK_THAT(error_of([&] { cut_out(with_squares(1), {input}, config, out); }),
               Contains("is an input in the place of a result"));
}

}  // namespace lacuna::test
