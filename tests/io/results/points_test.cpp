// SPDX-License-Identifier: Apache-2.0

#include "io/write/results/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

std::string written(const ScratchFolder& folder, const std::vector<ScanInput>& inputs, std::size_t rows,
                    const std::string& name, const FilesConfig& config = with_points()) {
  const ScanFiles scan(inputs, {});
  write_results(FakeDetection().with_results(rows), scan, config, folder / "out");
  return read_file(folder / "out" / name);
}

const std::string kText = "1 2 3\n4 5 6\n";
const std::string kPly = ascii_ply("1 2 3\n");

std::string las_bytes() {
  LasFile las;
  las.points = {las_point(20, 1, 2, 3)};
  return las.bytes();
}

constexpr const char* kResults =
    "scalar_probability,scalar_angle,scalar_halfdisc,scalar_shape,scalar_boundary,scalar_coherent,scalar_"
    "loop";

}  // namespace

TEST_CASE(
    "each file of a scan has its annotated one of the same name in the folder points, in its own format",
    "[io][results]") {
  const ScratchFolder folder;
  fs::create_directory(folder / "in");
  const std::vector<std::pair<std::string, std::string>> inputs = {
      {"a.xyz", kText},       {"b.ply", kPly}, {"c.d.pcd", ascii_pcd("1 2 3\n")},
      {"e.LAS", las_bytes()}, {"f", kPly},     {"g.obj", "v 1 2 3\n"}};
  std::vector<ScanInput> names;
  for (const auto& [name, content] : inputs) names.emplace_back(folder.write("in/" + name, content));
  const ScanFiles scan(names, {});
  const auto written = write_results(FakeDetection().with_results(7), scan, with_points(), folder / "out");
  CHECK(std::count(written.begin(), written.end(), folder / "out" / "points") == 1);
  CHECK(names_of(folder / "out" / "points") == Names{"a.csv", "b.ply", "c.d.ply", "e.las", "f.ply", "g.ply"});
  double first = 0;  // the ids of results go on from file to file
  for (const auto& [name, column] : {std::pair("a.csv", "scalar_probability"),
                                     {"b.ply", "scalar_probability"},
                                     {"c.d.ply", "scalar_probability"},
                                     {"e.las", "probability"},
                                     {"f.ply", "scalar_probability"},
                                     {"g.ply", "scalar_probability"}}) {
    INFO(name);
    const Table table = read_table(folder / "out" / "points" / name);
    for (const double value : table.column(column)) CHECK(value == first++);
  }
  CHECK(first == 7);
}

TEST_CASE("files of one name from two folders are an error before the work, but with one file for all",
          "[io][results]") {
  const ScratchFolder folder;
  for (const char* name : {"a", "b"}) fs::create_directory(folder / name);
  const ScanFiles scan({folder.write("a/x.xyz", kText), folder.write("b/x.txt", kText)}, {});
  const auto check = [&](const FilesConfig& config) { return error_of([&] { check_points(scan, config); }); };
  CHECK_THAT(check(with_points()), Contains("b/x.txt: ") && Contains("would both be points/x.csv"));
  CHECK(check(with_points(PointsFormat::kPly)).empty());
  CHECK(check({}).empty());
}

TEST_CASE("a LAS file with a pose becomes PLY, at its place in the scan", "[io][results]") {
  const ScratchFolder folder;
  Pose pose = Pose::Identity();
  pose.translate(Eigen::Vector3d(1, 2, 3));
  const std::string las = folder.write("a.las", las_bytes());
  const ScanFiles scan({ScanInput(las, pose)}, {});
  write_results(FakeDetection().with_results(1), scan, with_points(), folder / "out");
  const std::vector<double> before = read_table(las).rows.at(0),
                            after = read_table(folder / "out" / "points" / "a.ply").rows.at(0);
  for (std::size_t axis = 0; axis < 3; ++axis)
    CHECK(after[axis] == before[axis] + static_cast<double>(axis + 1));
}

TEST_CASE("points.csv has every number as the shortest text that reads back as it", "[io][results]") {
  const ScratchFolder folder;
  const std::string rows =
      "0.1 0.1 1e300 255 -128 4294967295 nan inf -0\n-5400000.123456789 3 -1e-7 0 1 2 -nan -inf 7\n"
      "nan 16777216 2 3 4 5 6 7 8\n";
  const std::string properties =
      "property double x\nproperty float y\nproperty double z\nproperty uchar red\nproperty char c\n"
      "property uint id\nproperty float a,b\nproperty float 3d\nproperty float nan\n";
  const auto ply = folder.write("a.ply", ascii_ply(rows, properties));
  const std::string csv = written(folder, {ply}, 3, "points.csv", with_points(PointsFormat::kCsv));
  CHECK(csv == std::string("x,y,z,red,c,id,a_b,\"3d\",\"nan\",") + kResults +
                   "\n0.1,0.1,1e+300,255,-128,4294967295,nan,inf,-0,0,0.25,0.5,0.75,1,0,-1\n"
                   "-5400000.123456789,3,-1e-07,0,1,2,nan,-inf,7,1,0.25,0.5,0.75,1,0,-1\n"
                   "nan,16777216,2,3,4,5,6,7,8,2,0.25,0.5,0.75,1,0,-1\n");
  const Table table = read_table(folder / "out" / "points.csv");
  CHECK(table.names[6] == "a_b");
  CHECK(table.names[7] == "3d");
  CHECK(table.names[8] == "nan");
  CHECK(table.rows[1][0] == -5400000.123456789);
  CHECK(table.rows[0][2] == 1e300);
}

TEST_CASE("names of columns in points.csv are UTF-8, and no formulas to a spreadsheet", "[io][results]") {
  const ScratchFolder folder;
  std::string properties = kXyz;
  for (const std::string name :
       {"=cmd|'/C", "+1", "-x", "@SUM(1)", "a=b", "\xff\xc3\xb6", "\x1b[2J", "_=cmd|'/C"})
    properties += "property float " + name + "\n";
  const auto ply = folder.write("a.ply", ascii_ply("1 2 3 4 5 6 7 8 9 10 11\n", properties));
  const std::string csv = written(folder, {ply}, 1, "points.csv", with_points(PointsFormat::kCsv));
  CHECK(csv.substr(0, csv.find(",scalar_")) ==
        "x,y,z,_=cmd|'/C,_+1,_-x,_@SUM(1),a=b,\"\xef\xbf\xbd\xc3\xb6\",_[2J,_=cmd|'/C_2");
}

TEST_CASE("points.csv of text files has their columns, and a run on it replaces the results",
          "[io][results]") {
  const ScratchFolder folder;
  const auto a = folder.write("a.txt", "x;y;z;depth\n1,5;2;3;0,25\n4;5;6;7\n"),
             b = folder.write("b.pts", "1\n7 8 9\n");
  const std::string csv = written(folder, {a, b}, 3, "points.csv", with_points(PointsFormat::kCsv));
  CHECK(csv == std::string("x,y,z,depth,") + kResults +
                   "\n1.5,2,3,0.25,0,0.25,0.5,0.75,1,0,-1\n4,5,6,7,1,0.25,0.5,0.75,1,0,-1\n"
                   "7,8,9,nan,2,0.25,0.5,0.75,1,0,-1\n");
  const ScratchFolder again;
  CHECK(written(again, {folder / "out" / "points.csv"}, 3, "points/points.csv") == csv);
}

TEST_CASE("points.ply has quality, the probability for MeshLab, unless the scan has a quality",
          "[io][results]") {
  const ScratchFolder folder;
  const FilesConfig one = with_points(PointsFormat::kPly);
  const auto quality = [&] { return read_table(folder / "out" / "points.ply").column("quality"); };
  const auto plain = folder.write("a.ply", kPly);
  const std::string first = written(folder, {plain}, 1, "points.ply", one);
  CHECK(quality() == std::vector<double>{0});
  const std::string earlier = folder.write("earlier.ply", first);
  CHECK((written(folder, {earlier}, 1, "points.ply", one) == first));

  std::string own = kPly;
  own.replace(own.find("end_header"), 0, "property float quality\n");
  own.insert(own.size() - 1, " 42");
  const auto file = folder.write("own.ply", own);
  const std::string kept = written(folder, {file}, 1, "points.ply", one);
  CHECK(quality() == std::vector<double>{42});
  const std::string next = folder.write("next.ply", kept);
  CHECK((written(folder, {next}, 1, "points.ply", one) == kept));
}

TEST_CASE("blocks of results do not change the bytes of any format", "[io][results]") {
  const ScratchFolder folder;
  std::string text = "x y z red green blue intensity\n";
  for (int i = 0; i < 50; ++i)
    text += std::to_string(i) + (i % 7 == 0 ? " nan" : " 1.25") + " 2 1 2 3 " + std::to_string(i) + "\n";
  LasFile las;
  for (int i = 0; i < 50; ++i) las.points.push_back(las_point(20, i, 2 * i, 3));
  const std::vector<ScanInput> inputs = {folder.write("a.txt", text), folder.write("b.las", las.bytes())};
  for (const PointsFormat format : {PointsFormat::kInput, PointsFormat::kPly, PointsFormat::kCsv}) {
    std::string one;
    for (const std::size_t block : {1u, 3u, 99u, 1000u}) {
      const ScanFiles scan(inputs, {});
      FakeDetection detection;
      detection.with_results(100).block = block;
      for (const int threads : {1, 4}) {
        FilesConfig config = with_points(format);
        config.run.threads = threads;
        write_results(detection, scan, config, folder / "out");
        std::string bytes;
        for (const char* name : {"points.ply", "points.csv", "points/a.csv", "points/b.las"})
          if (fs::exists(folder / "out" / name)) bytes += read_file(folder / "out" / name);
        CHECK(bytes.size() > 1000);
        if (one.empty()) one = bytes;
        CHECK((bytes == one));
      }
    }
  }
}

}  // namespace lacuna::test
