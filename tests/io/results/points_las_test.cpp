// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_writer.hpp"
#include "io/laz/laz_encoder.hpp"
#include "io/results/points.hpp"
#include "tests/io/results/points_las_support.hpp"
#include "tests/support/laz_data.hpp"

namespace lacuna::test {
using namespace io;

using Catch::Matchers::Contains;

TEST_CASE("points.las has every byte of the points, records and header of a LAS file", "[io][results]") {
  for (int format = 0; format <= 10; ++format) {
    for (const int minor : {format < 4 ? 0 : format < 6 ? 3 : 4, 4}) {
      INFO("point format " << format << " of LAS 1." << minor);
      const ScratchFolder folder;
      LasFile las = file_of(format, minor, 2 + 8 + 3);
      const std::string record = las_record("somebody", 77, std::string("any\0thing", 9));
      std::string scaled = las_extra_descriptor("height", 3, 8 + 16, 0.01, 2.5);
      std::memcpy(&scaled[160], "above ground", 12);
      // The last three bytes have no descriptor.
      const std::string exact = las_extra_descriptor("pulse", 8);
      las.records = {record, las_record("LASF_Spec", 4, scaled + exact), record,
                     las_record("LASF_Projection", 2112, "PROJCS[\"here\"]")};
      std::string bytes = las.bytes();
      const std::string extended = extended_record("somebody", 78, std::string(100'000, 'x'));
      if (minor == 4) {
        put<std::uint64_t>(bytes, 235, bytes.size());
        put<std::uint32_t>(bytes, 243, 3);
        bytes +=
            extended + extended_record("copc", 1000, "gone") + extended_record("LASF_Spec", 65535, "waves");
        put<std::uint64_t>(bytes, 227, bytes.size() - 65);
        for (std::size_t i = 0; i < 15; ++i) put<std::uint64_t>(bytes, 255 + 8 * i, i);
      }
      put<std::uint16_t>(bytes, 4, minor > 0 ? 4321 : 0);
      if (minor >= 2) put<std::uint16_t>(bytes, 6, 0x13);
      for (std::size_t i = 8; i < 24; ++i) bytes[i] = static_cast<char>(i);
      std::memcpy(&bytes[26], "a scanner", 9);
      std::memcpy(&bytes[58], "its software", 12);
      put<std::uint16_t>(bytes, 90, 321);
      put<std::uint16_t>(bytes, 92, 2019);
      for (std::size_t i = 0; i < 5 && minor < 4; ++i) put<std::uint32_t>(bytes, 111 + 4 * i, 1 + i);
      for (std::size_t i = 0; i < 6; ++i) put<double>(bytes, 179 + 8 * i, 7.5 * static_cast<double>(i));

      FileScan scan({folder.write("a.las", bytes)}, {});
      const std::string out = detect_to(folder, scan, 5, las_config());
      CHECK(out.substr(0, 4) == "LASF");
      CHECK(out.substr(4, 20) == bytes.substr(4, 20));
      CHECK(at<std::uint8_t>(out, 24) == 1);
      CHECK(at<std::uint8_t>(out, 25) == 4);
      CHECK(out.substr(26, 32) == bytes.substr(26, 32));
      CHECK(out.substr(58, 13) == std::string("Lacuna 0.1.0\0", 13));
      CHECK(out.substr(90, 4) == bytes.substr(90, 4));
      CHECK(at<std::uint16_t>(out, 94) == 375);
      CHECK(at<std::uint32_t>(out, 100) == 4);
      CHECK(at<std::uint8_t>(out, 104) == format);
      CHECK(at<std::uint16_t>(out, 105) == las.points[0].size() + kResultBytes);
      CHECK(out.substr(107, 227 - 107) == bytes.substr(107, 227 - 107));  // counts, scale, offset, bounds
      CHECK(at<std::uint64_t>(out, 247) == 5);
      for (std::size_t i = 0; i < 15; ++i)
        CHECK(at<std::uint64_t>(out, 255 + 8 * i) == (minor == 4 ? i : i < 5 ? i + 1 : 0));

      // Records, and the descriptors of extra bytes last.
      const std::string projection = las.records[3];
      CHECK(out.substr(375, 2 * record.size() + projection.size()) == record + record + projection);
      const std::size_t described = 375 + 2 * record.size() + projection.size();
      CHECK(out.substr(described + 2, 10) == std::string("LASF_Spec\0", 10));
      CHECK(at<std::uint16_t>(out, described + 18) == 4);
      CHECK(at<std::uint16_t>(out, described + 20) == 192 * 10);
      CHECK(out.substr(described + 54, 192 * 2) == scaled + exact);
      const std::size_t unnamed = described + 54 + 192 * 2, first = unnamed + 192;
      CHECK(at<std::uint8_t>(out, unnamed + 2) == 0);
      CHECK(at<std::uint8_t>(out, unnamed + 3) == 3);
      CHECK(at<std::uint8_t>(out, first + 2) == 9);
      CHECK(out.substr(first + 4, 12) == std::string("probability\0", 12));
      CHECK(at<std::uint8_t>(out, first + 6 * 192 + 2) == 6);
      CHECK(out.substr(first + 6 * 192 + 4, 5) == std::string("loop\0", 5));
      CHECK(at<std::uint32_t>(out, 96) == first + 7 * 192);

      const std::size_t record_bytes = las.points[0].size();
      for (std::size_t i = 0; i < 5; ++i) {
        CHECK(point_of(out, i, record_bytes) == las.points[i]);
        const std::string results = point_of(out, i, record_bytes + kResultBytes).substr(record_bytes);
        CHECK(at<float>(results, 0) == static_cast<float>(i));
        CHECK(at<float>(results, 12) == 0.75f);
        CHECK(at<std::uint8_t>(results, 16) == 1);
        CHECK(at<std::int32_t>(results, 18) == -1);
      }
      const std::size_t end = at<std::uint32_t>(out, 96) + 5 * (record_bytes + kResultBytes);
      if (minor == 4) {
        CHECK(at<std::uint64_t>(out, 235) == end);
        CHECK(at<std::uint32_t>(out, 243) == 2);
        CHECK(out.substr(end) == extended + extended_record("LASF_Spec", 65535, "waves"));
        CHECK(at<std::uint64_t>(out, 227) == end + extended.size());
      } else {
        CHECK(out.size() == end);
        CHECK(at<std::uint32_t>(out, 243) == 0);
      }
      const Table written = read_table(folder / "out" / "points.las");
      check_columns(read_table(folder / "a.las"), written);
      CHECK(column(written, "probability") == std::vector<double>{0, 1, 2, 3, 4});

      // The next run replaces the results, not more.
      const ScratchFolder again;
      FileScan second({folder / "out" / "points.las"}, {});
      const std::string twice = detect_to(again, second, 5, las_config());
      CHECK(twice.size() == out.size());
      CHECK((twice == out));
    }
  }
}

TEST_CASE("waveforms of LAS 1.3 behind the points become an extended record", "[io][results]") {
  const ScratchFolder folder;
  std::string bytes = file_of(4, 3).bytes();
  put<std::uint16_t>(bytes, 6, 2);
  put<std::uint64_t>(bytes, 227, bytes.size());
  const std::string waves = extended_record("LASF_Spec", 65535, "up and down");
  FileScan scan({folder.write("a.las", bytes + waves)}, {});
  const std::string out = detect_to(folder, scan, 5, las_config());
  CHECK(out.ends_with(waves));
  CHECK(at<std::uint64_t>(out, 227) == out.size() - waves.size());
  CHECK(at<std::uint64_t>(out, 235) == out.size() - waves.size());
  CHECK(at<std::uint32_t>(out, 243) == 1);
}

TEST_CASE("points.las of a LAZ file is LAS with the same points, without what LASzip needs",
          "[io][results]") {
  const ScratchFolder folder;
  LasFile las = file_of(7, 4, 2);
  const std::string described = las_record("LASF_Spec", 4, las_extra_descriptor("mine", 3));
  las.records = {described};
  const auto plain = folder.write("plain.las", las.bytes());
  const laz::Layout layout = laz_layout(7, 2, 50'000, 3);
  const auto text = [](const LazBytes& data) {
    return std::string(reinterpret_cast<const char*>(data.data()), data.size());
  };
  las.records.push_back(las_record("laszip encoded", 22204, text(laz::layout_record(layout))));
  std::string bytes = las.bytes();
  bytes.resize(bytes.size() - 5 * las.points[0].size());
  put(bytes, 104, static_cast<std::uint8_t>(7 | 0x80));
  std::string points;
  for (const std::string& point : las.points) points += point;
  bytes += text(
      laz_point_data(layout, std::as_bytes(std::span(points)), std::vector<std::uint64_t>{5}, bytes.size()));
  std::string out[2];
  const std::string files[] = {plain, folder.write("a.laz", bytes)};
  FilesConfig config = las_config();
  config.output.points_format = PointsFormat::kLas;
  for (std::size_t i = 0; i < 2; ++i) {
    FileScan scan({files[i]}, {});
    out[i] = detect_to(folder, scan, 5, config);
  }
  CHECK((out[0] == out[1]));
  CHECK_THAT(out[1], !Contains("laszip"));
}

TEST_CASE("a pose moves the points of points.las and leaves all else", "[io][results]") {
  const ScratchFolder folder;
  LasFile las = file_of(6, 4);
  las.records = {las_record("LASF_Projection", 2112, "PROJCS[\"here\"]"), las_record("kept", 1, "kept")};
  const std::string file = folder.write("a.las", las.bytes());
  Pose pose = Pose::Identity();
  pose.translate(Eigen::Vector3d(-500'000, 0.5, 7));
  FileScan scan({ScanInput(file, pose)}, {});
  const std::string out = detect_to(folder, scan, 5, las_config());
  const Table before = read_table(file), after = read_table(folder / "out" / "points.las");
  const double scale = at<double>(out, 131);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(column(after, "x")[i] == Approx(column(before, "x")[i] - 500'000).margin(scale));
    CHECK(column(after, "y")[i] == Approx(column(before, "y")[i] + 0.5).margin(scale));
    CHECK(column(after, "z")[i] == Approx(column(before, "z")[i] + 7).margin(scale));
    CHECK(point_of(out, i, 30).substr(12) == las.points[i].substr(12));
  }
  CHECK_THAT(out, !Contains("PROJCS") && Contains("kept"));
}

TEST_CASE("points.las has the system that holds for the scan, not the records of its first file",
          "[io][results]") {
  const std::string here = "PROJCS[\"here\",UNIT[\"metre\",1]]",
                    there = "PROJCS[\"there\",UNIT[\"foot\",0.3048]]";
  const auto crs_of = [&](int format, const std::string& crs, const std::vector<std::string>& other_crs,
                          const std::string& stated) {
    const ScratchFolder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
      LasFile las = file_of(format, format < 6 ? 2 : 4);
      las.records = {las_record("kept", 1, "kept")};
      if (!text.empty()) las.records.push_back(las_record("LASF_Projection", 2112, text));
      return folder.write(name + ".las", las.bytes());
    };
    std::vector<ScanInput> inputs = {write("a", crs)};
    for (const std::string& other : other_crs) inputs.emplace_back(write("b", other));
    FilesConfig config = las_config();
    config.input.crs = stated;
    FileScan scan(inputs, config.input);
    const std::string out = detect_to(folder, scan, 5 * inputs.size(), config);
    CHECK_THAT(out, Contains("kept"));
    const std::string written = open_scan(folder / "out" / "points.las", {})->crs();
    const bool has_text_bit = (at<std::uint16_t>(out, 6) & 16) != 0;
    if (!stated.empty()) CHECK(has_text_bit == (stated == there));
    return written;
  };
  for (const int format : {1, 6}) {
    INFO("point format " << format);
    CHECK(crs_of(format, here, {}, "") == here);
    CHECK(crs_of(format, here, {}, there) == there);
    CHECK(crs_of(format, "", {}, there) == there);
    CHECK(crs_of(format, here, {}, "EPSG:25832") == "EPSG:25832");
    CHECK(crs_of(format, "", {here}, "") == here);
    CHECK(crs_of(format, here, {there}, "").empty());
    CHECK(crs_of(format, here, {there}, there) == there);
  }
}

TEST_CASE("rows of other formats become LAS points, and nothing of them is lost", "[io][results]") {
  const ScratchFolder folder;
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty ushort Intensity\n"
      "property float scalar_Classification\nproperty float return_number\nproperty double gps_time\n"
      "property uchar alpha\nproperty int id\nproperty float intensity_2\nend_header\n";
  FileScan scan({folder.write("a.ply", header + "500000.125 5400000.5 1 255 0 7 65535 2 0.5 1.25 9 -7 0.1\n"
                                                "500001.5 5400001.25 -2 1 2 3 0 200 1 2.5 8 -8 0.2\n"
                                                "nan 0 0 1 1 1 1 1 1 1 1 1 1\n"
                                                "500002 5400002 3 4 5 6 7 31 2 3.5 7 -9 nan\n")},
                {});
  FilesConfig config = las_config();
  config.output.points_format = PointsFormat::kLas;
  const std::string out = detect_to(folder, scan, 4, config);
  CHECK(at<std::uint8_t>(out, 104) == 7);
  CHECK(at<std::uint16_t>(out, 6) == 16);
  CHECK(at<std::uint64_t>(out, 247) == 3);
  const Table table = read_table(folder / "out" / "points.las");
  using Values = std::vector<double>;
  CHECK(column(table, "x") == Values{500000.125, 500001.5, 500002});
  CHECK(column(table, "y") == Values{5400000.5, 5400001.25, 5400002});
  CHECK(column(table, "z") == Values{1, -2, 3});
  CHECK(column(table, "red") == Values{65535, 257, 4 * 257});
  CHECK(column(table, "intensity") == Values{65535, 0, 7});
  CHECK(column(table, "classification") == Values{2, 200, 31});
  CHECK(column(table, "return_number") == Values{0, 0, 0});  // its values are no whole numbers:
  CHECK(column(table, "return_number_2") == Values{0.5, 1, 2});
  CHECK(column(table, "gps_time") == Values{1.25, 2.5, 3.5});
  CHECK(column(table, "alpha") == Values{9, 8, 7});
  CHECK(column(table, "id") == Values{-7, -8, -9});
  CHECK(is_same(column(table, "intensity_2"), Values{0.1f, 0.2f, std::nan("")}));
  CHECK(column(table, "probability") == Values{0, 1, 3});
  const auto reader = open_scan(folder / "out" / "points.las", {});
  CHECK(reader->layout().find("id")->type == Scalar::kInt32);
}

TEST_CASE("LAS and other files together share fields and extra bytes by name", "[io][results]") {
  const ScratchFolder folder;
  LasFile las = file_of(1, 2, 4);
  las.records = {las_record("LASF_Spec", 4, las_extra_descriptor("depth", 9)), las_record("kept", 1, "kept")};
  for (std::string& point : las.points) put(point, 28, 0.5f);
  const std::string text = "x y z intensity depth\n500000.1234 5400000.5 1 3 0.25\n";
  FileScan scan({folder.write("t.xyz", text), folder.write("a.las", las.bytes())}, {});
  CHECK(points_format(scan, {}) == PointsFormat::kPly);
  FilesConfig config = las_config();
  config.output.points_format = PointsFormat::kLas;
  detect_to(folder, scan, 6, config);
  const Table table = read_table(folder / "out" / "points.las");
  CHECK(column(table, "x")[0] == Approx(500000.1234).margin(0.006));
  CHECK(column(table, "intensity")[0] == 3);
  CHECK(column(table, "depth") == std::vector<double>{0.25, 0.5, 0.5, 0.5, 0.5, 0.5});
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(column(table, "x")[i + 1] == Approx(column(read_table(folder / "a.las"), "x")[i]).epsilon(1e-14));
}

TEST_CASE("a coordinate system without a LAS file stands in points.las as text or as keys", "[io][results]") {
  const ScratchFolder folder;
  std::string long_text(70'000, 'x');
  long_text.insert(0, "PROJCS[\"");
  long_text += "\"]";
  for (const std::string& crs : {std::string("PROJCS[\"here\"]"), long_text, std::string("EPSG:25832"),
                                 std::string("EPSG:4258+5783")}) {
    LasParts parts;
    parts.imported = {{.property = {"x", Scalar::kFloat64, 0}}};
    parts.crs = crs;
    const LasForm form = join_las(parts);
    const bool has_code = crs.starts_with("EPSG");
    CHECK(form.point_format == (has_code ? 0 : 6));
    const auto file = folder / "a.las";
    std::filesystem::remove(file);
    OutputFile out(file, file);
    LasWriter writer(out, form, {}, {}, crs);
    const std::string point = las_point(form.record_bytes, 1, 2, 3);
    writer.put(std::as_bytes(std::span(point)));
    writer.finish();
    out.close();
    CHECK((open_scan(file, {})->crs() == crs));
    CHECK(read_table(file).rows.size() == 1);
    CHECK(at<std::uint16_t>(read_file(file), 6) == (has_code ? 0 : 16));
  }
}

TEST_CASE("extra bytes of another program with the name of a result stay", "[io][results]") {
  const ScratchFolder folder;
  LasFile las = file_of(6, 4, 1);
  las.records = {las_record("LASF_Spec", 4, las_extra_descriptor("probability", 1))};
  FileScan scan({folder.write("a.las", las.bytes())}, {});
  detect_to(folder, scan, 5, las_config());
  const Table table = read_table(folder / "out" / "points.las");
  CHECK(column(table, "probability") == column(read_table(folder / "a.las"), "probability"));
  CHECK(column(table, "lacuna_probability") == std::vector<double>{0, 1, 2, 3, 4});
}

TEST_CASE("damaged LAS files are errors for points.las, or read as they are, and never more",
          "[io][results]") {
  const ScratchFolder folder;
  LasFile las = file_of(3, 4, 4);
  las.records = {las_record("LASF_Spec", 4, las_extra_descriptor("depth", 9)),
                 las_record("other", 1, "data")};
  std::string bytes = las.bytes();
  put<std::uint64_t>(bytes, 235, bytes.size());
  put<std::uint32_t>(bytes, 243, 1);
  bytes += extended_record("other", 2, "more data");
  std::mt19937 random(7);
  for (int i = 0; i < 600; ++i) {
    std::string damaged = bytes;
    const std::size_t place = 24 + random() % (damaged.size() - 24);
    damaged[place] = static_cast<char>(random());
    const auto file = folder.write("a.las", damaged);
    error_of([&] {
      FileScan scan({file}, {});
      const std::uint64_t rows = scan.expected_points().value_or(0);
      if (rows > 100) return;
      detect_to(folder, scan, rows, las_config());
      check_columns(read_table(file), read_table(folder / "out" / "points.las"));
    });
  }
}

}  // namespace lacuna::test
