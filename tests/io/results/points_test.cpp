// SPDX-License-Identifier: Apache-2.0
#include "io/results/points.hpp"

#include "io/results/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/las/las_file.hpp"
#include "tests/io/results/fake_detection.hpp"

#include <cmath>

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace io;

namespace {

using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

FilesConfig with_points(PointsFormat format = PointsFormat::kInput) {
  FilesConfig config;
  config.results.points = true;
  config.output.points_format = format;
  return config;
}

std::string written(const ScratchFolder& folder, const std::vector<ScanInput>& inputs, std::size_t rows,
                    const std::string& name, const FilesConfig& config = with_points()) {
  FileScan scan(inputs, {});
  write_results(FakeDetection().with_results(rows), scan, config, folder / "out");
  return read_file(folder / "out" / name);
}

const std::string kText = "1 2 3\n4 5 6\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
    "z\nend_header\n1 2 3\n";
const std::string kPcd =
    "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA "
    "ascii\n1 2 3\n";

std::string las_bytes() {
  LasFile las;
  las.points = {las_point(20, 1, 2, 3)};
  return las.bytes();
}

constexpr const char* kResults =
    "scalar_probability,scalar_angle,scalar_halfdisc,scalar_shape,scalar_boundary,scalar_coherent,scalar_"
    "loop";

}  // namespace

TEST_CASE("the annotated scan has the format of its files, or PLY where they differ or cannot be written",
          "[io][results]") {
  const ScratchFolder folder;
  const std::string text = folder.write("a.xyz", kText), ply = folder.write("a.ply", kPly),
                    pcd = folder.write("a.pcd", kPcd), las = folder.write("a.las", las_bytes()),
                    off = folder.write("a.off", "OFF\n1 0 0\n1 2 3\n"), other = folder.write("b.txt", kText);
  const auto chosen = [](std::vector<ScanInput> inputs, PointsFormat format = PointsFormat::kInput) {
    const FileScan scan(std::move(inputs), {});
    return points_file(scan, with_points(format).output);
  };
  CHECK(chosen({text}) == "points.csv");
  CHECK(chosen({text, other}) == "points.csv");
  CHECK(chosen({ply}) == "points.ply");
  CHECK(chosen({pcd}) == "points.pcd");
  CHECK(chosen({las}) == "points.las");
  CHECK(chosen({off}) == "points.ply");
  CHECK(chosen({pcd, las}) == "points.ply");
  CHECK(chosen({pcd, las}, PointsFormat::kCsv) == "points.csv");
  CHECK(chosen({text}, PointsFormat::kPcd) == "points.pcd");
}

TEST_CASE("the annotated scan of another format goes, and one of another program is refused",
          "[io][results]") {
  const ScratchFolder folder;
  FileScan scan({folder.write("a.ply", kPly)}, {});
  const auto detection = FakeDetection().with_results(1);
  const std::vector<std::pair<PointsFormat, std::string>> formats = {{PointsFormat::kPly, "points.ply"},
                                                                     {PointsFormat::kLas, "points.las"},
                                                                     {PointsFormat::kLaz, "points.laz"},
                                                                     {PointsFormat::kPcd, "points.pcd"},
                                                                     {PointsFormat::kCsv, "points.csv"}};
  for (const auto& [before, older] : formats) {
    for (const auto& [format, name] : formats) {
      write_results(detection, scan, with_points(before), folder / "out");
      write_results(detection, scan, with_points(format), folder / "out");
      for (const auto& [any, file] : formats)
        CHECK(std::filesystem::exists(folder / "out" / file) == (file == name));
      write_results(detection, scan, FilesConfig{}, folder / "out");
      CHECK_FALSE(std::filesystem::exists(folder / "out" / name));
    }
  }
  for (const auto& [format, name] : formats) {
    const ScratchFolder mine;
    const bool is_las = name == "points.las" || name == "points.laz";
    const std::string content = is_las ? las_bytes() : name == "points.pcd" ? kPcd : "x,y,z\n1,2,3\n";
    mine.write(name, content);
    for (const auto& [wanted, other] : formats) {
      const std::string error = error_of(
          [&, &wanted = wanted] { write_results(detection, scan, with_points(wanted), mine.path()); });
      CHECK(error.empty() == (wanted != format));
      if (wanted == format) CHECK_THAT(error, Contains(name + ": exists, and this command did not write it"));
      CHECK(read_file(mine / name) == content);
    }
  }
}

TEST_CASE("points.csv has every number as the shortest text that reads back as it", "[io][results]") {
  const ScratchFolder folder;
  const auto ply = folder.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty float y\nproperty double z\n"
      "property uchar red\nproperty char c\nproperty uint id\nproperty float a,b\nproperty float "
      "3d\nproperty float nan\n"
      "end_header\n0.1 0.1 1e300 255 -128 4294967295 nan inf -0\n-5400000.123456789 3 -1e-7 0 1 2 -nan -inf "
      "7\n"
      "nan 16777216 2 3 4 5 6 7 8\n");
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
  std::string header = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (const std::string name : {"x", "y", "z", "=cmd|'/C calc'!A1", "+1", "-x", "@SUM(1)", "a=b",
                                 "\xff\xc3\xb6", "\x1b[2J", "_=cmd|'/C"}) {
    header += "property float " + name.substr(0, name.find(' ')) + "\n";
  }
  const auto ply = folder.write("a.ply", header + "end_header\n1 2 3 4 5 6 7 8 9 10 11\n");
  const std::string csv = written(folder, {ply}, 1, "points.csv", with_points(PointsFormat::kCsv));
  CHECK(csv.substr(0, csv.find(",scalar_")) ==
        "x,y,z,_=cmd|'/C,_+1,_-x,_@SUM(1),a=b,\"\xef\xbf\xbd\xc3\xb6\",_[2J,_=cmd|'/C_2");
}

TEST_CASE("points.csv of text files has their columns, and a run on it replaces the results",
          "[io][results]") {
  const ScratchFolder folder;
  const auto a = folder.write("a.txt", "x;y;z;depth\n1,5;2;3;0,25\n4;5;6;7\n"),
             b = folder.write("b.pts", "1\n7 8 9\n");
  const std::string csv = written(folder, {a, b}, 3, "points.csv");
  CHECK(csv == std::string("x,y,z,depth,") + kResults +
                   "\n1.5,2,3,0.25,0,0.25,0.5,0.75,1,0,-1\n4,5,6,7,1,0.25,0.5,0.75,1,0,-1\n"
                   "7,8,9,nan,2,0.25,0.5,0.75,1,0,-1\n");
  const ScratchFolder again;
  CHECK(written(again, {folder / "out" / "points.csv"}, 3, "points.csv") == csv);
}

TEST_CASE("points.pcd keeps the fields of a PCD file as they are, and its image", "[io][results]") {
  const ScratchFolder folder;
  const std::string fields =
      "FIELDS x _ y z rgb id hist normal_x\nSIZE 4 1 4 8 4 8 2 4\nTYPE F U F F F U I F\nCOUNT 1 3 1 1 1 1 2 "
      "1\n";
  const std::string image = "WIDTH 2\nHEIGHT 2\nVIEWPOINT 1.5 -2 3 0.5 0.5 0.5 0.5\nPOINTS 4\n";
  Bytes rows, kept;
  for (int i = 0; i < 4; ++i) {
    const float x = i == 1 ? std::nanf("") : 1.f + static_cast<float>(i);
    rows << x << std::uint8_t{1} << std::uint16_t{2};
    kept << x;
    for (Bytes* to : {&rows, &kept})
      *to << 2.f << 0.1 << std::uint32_t{0xff010203u + static_cast<unsigned>(i)}
          << 0xffff'ffff'ffff'fff0ull + static_cast<unsigned>(i) << std::int16_t{-1} << std::int16_t{5}
          << 0.5f;
    kept << static_cast<float>(i) << 0.25f << 0.5f << 0.75f << std::uint8_t{1} << std::uint8_t{0}
         << std::int32_t{-1};
  }
  const auto file = folder.write("a.pcd", "VERSION .7\n" + fields + image + "DATA binary\n" + rows.str());
  const std::string pcd = written(folder, {file}, 4, "points.pcd");
  const std::string header =
      "# .PCD v0.7 - written by Lacuna\nVERSION 0.7\nFIELDS x y z rgb id hist normal_x scalar_probability "
      "scalar_angle scalar_halfdisc scalar_shape scalar_boundary scalar_coherent scalar_loop\n"
      "SIZE 4 4 8 4 8 2 4 4 4 4 4 1 1 4\nTYPE F F F F U I F F F F F U U I\nCOUNT 1 1 1 1 1 2 1 1 1 1 1 1 1 "
      "1\n"
      "WIDTH 2\nHEIGHT 2\nVIEWPOINT 1.5 -2 3 0.5 0.5 0.5 0.5\nPOINTS 4\nDATA binary\n";
  CHECK(pcd.substr(0, header.size()) == header);
  CHECK((pcd.substr(header.size()) == kept.str()));
  const ScratchFolder again;
  CHECK((written(again, {folder / "out" / "points.pcd"}, 4, "points.pcd") == pcd));

  // Two such files are no image any more.
  const std::string both = written(folder, {file, file}, 8, "points.pcd");
  CHECK_THAT(both, Contains("WIDTH 8\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 8\n"));
  CHECK(both.size() ==
        pcd.size() + kept.str().size() - (std::string("1.5 -2 3 0.5 0.5 0.5 0.5").size() - 13));
}

TEST_CASE("points.pcd of other formats has PCL's names and packed colours", "[io][results]") {
  const ScratchFolder folder;
  const auto ply = folder.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nproperty int id\nproperty float rgb\nend_header\n1 2 3 0 0 1 10 20 30 -4 0.5\n4 "
      "5 6 1 0 0 1 2 3 5 1.5\n");
  const std::string pcd = written(folder, {ply}, 2, "points.pcd", with_points(PointsFormat::kPcd));
  CHECK_THAT(pcd,
             Contains("\nFIELDS x y z normal_x normal_y normal_z rgb id rgb_2 scalar_probability ") &&
                 Contains("\nSIZE 4 4 4 4 4 4 4 4 4 4 4 4 4 1 1 4\nTYPE F F F F F F F I F F F F F U U I\n"));
  const std::size_t rows = pcd.find("DATA binary\n") + 12;
  std::uint32_t colour = 0;
  std::memcpy(&colour, &pcd[rows + 24], 4);
  CHECK(colour == 0x0a141e);
  const Table table = read_table(folder / "out" / "points.pcd");
  CHECK(Names(table.names.begin(), table.names.begin() + 11) ==
        Names{"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "id", "rgb_2"});
  CHECK(table.rows[0] ==
        std::vector<double>{1, 2, 3, 0, 0, 1, 10, 20, 30, -4, 0.5, 0, 0.25, 0.5, 0.75, 1, 0, -1});
  CHECK(table.rows[1] ==
        std::vector<double>{4, 5, 6, 1, 0, 0, 1, 2, 3, 5, 1.5, 1, 0.25, 0.5, 0.75, 1, 0, -1});
}

TEST_CASE("points.ply has quality, the probability for MeshLab, unless the scan has a quality",
          "[io][results]") {
  const ScratchFolder folder;
  const auto column = [&](const std::string& name) {
    const Table table = read_table(folder / "out" / "points.ply");
    std::vector<double> values;
    for (std::size_t i = 0; i < table.names.size(); ++i) {
      if (table.names[i] == name) values.push_back(table.rows[0][i]);
    }
    return values;
  };
  const auto plain = folder.write("a.ply", kPly);
  const std::string first = written(folder, {plain}, 1, "points.ply");
  CHECK(column("quality") == std::vector<double>{0});
  const std::string earlier = folder.write("earlier.ply", first);
  CHECK((written(folder, {earlier}, 1, "points.ply") == first));

  std::string own = kPly;
  own.replace(own.find("end_header"), 0, "property float quality\n");
  own.insert(own.size() - 1, " 42");
  const auto file = folder.write("own.ply", own);
  const std::string kept = written(folder, {file}, 1, "points.ply");
  CHECK(column("quality") == std::vector<double>{42});
  const std::string next = folder.write("next.ply", kept);
  CHECK((written(folder, {next}, 1, "points.ply") == kept));
}

TEST_CASE("blocks of results do not change the bytes of any format", "[io][results]") {
  const ScratchFolder folder;
  std::string text = "x y z red green blue intensity\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(i) + (i % 7 == 0 ? " nan" : " 1.25") + " 2 1 2 3 " + std::to_string(i) + "\n";
  const auto file = folder.write("a.txt", text);
  for (const PointsFormat format :
       {PointsFormat::kPly, PointsFormat::kLas, PointsFormat::kLaz, PointsFormat::kPcd, PointsFormat::kCsv}) {
    std::string one;
    for (const std::size_t block : {1u, 3u, 99u, 1000u}) {
      FileScan scan({file}, {});
      FakeDetection detection;
      detection.with_results(100).block = block;
      for (const int threads : {1, 4}) {
        FilesConfig config = with_points(format);
        config.run.threads = threads;
        write_results(detection, scan, config, folder / "out");
        const std::string bytes = read_file(folder / "out" / points_file(scan, config.output));
        if (one.empty()) one = bytes;
        CHECK((bytes == one));
      }
    }
  }
}

}  // namespace lacuna::test
