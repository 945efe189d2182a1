// SPDX-License-Identifier: Apache-2.0
// Several LAS files as one points.las: their coordinates, and what cannot be joined.
#include "tests/io/results/points_las_support.hpp"

#include <functional>

namespace lacuna::test {
using namespace io;

using Catch::Matchers::Contains;

TEST_CASE("LAS files of different scales and formats are joined exactly", "[io][results]") {
  const ScratchFolder folder;
  LasFile a = file_of(1, 2, 4), b = file_of(7, 4, 2, 2), c = file_of(3, 2, 0, 3);
  const auto place = [](LasFile& las) {
    for (std::size_t i = 0; i < las.points.size(); ++i) {
      put(las.points[i], 0, static_cast<std::int32_t>(1000 * i + 7));
      put(las.points[i], 4, static_cast<std::int32_t>(i));
      put(las.points[i], 8, -static_cast<std::int32_t>(i));
    }
  };
  for (LasFile* las : {&a, &b, &c}) place(*las);
  b.scale = {0.001, 0.01, 0.002};
  b.offset = {499'000, 5'400'000.01, 12};
  c.scale = {0.1, 0.01, 0.001};
  a.records = {las_record("LASF_Spec", 4, las_extra_descriptor("mine", 9)), las_record("first", 1, "kept")};
  b.records = {las_record("LASF_Spec", 4, las_extra_descriptor("mine", 3)), las_record("second", 1, "not")};
  const std::vector<ScanInput> inputs{folder.write("a.las", a.bytes()), folder.write("b.las", b.bytes()),
                                      folder.write("c.las", c.bytes())};
  FileScan scan(inputs, {});
  const std::string out = detect_to(folder, scan, 15, las_config());
  CHECK(at<std::uint8_t>(out, 104) == 7);
  CHECK(at<double>(out, 131) == 0.001);
  CHECK(at<double>(out, 131 + 16) == 0.001);
  CHECK_THAT(out, Contains("kept") && !Contains("second"));
  const Table all = read_table(folder / "out" / "points.las");
  REQUIRE(all.rows.size() == 15);
  std::size_t row = 0;
  for (const ScanInput& input : inputs) {
    const Table table = read_table(input.file);
    for (std::size_t i = 0; i < 5; ++i, ++row) {
      for (const std::string name : {"x", "y", "z"})
        CHECK(column(all, name)[row] == Approx(column(table, name)[i]).epsilon(1e-14));
      for (const std::string& name : table.names) {
        if (name == "x" || name == "y" || name == "z") continue;
        const double before = column(table, name)[i], after = column(all, name)[row];
        INFO(name);
        if (name == "scan_angle" && row / 5 != 1) {
          CHECK(std::lround(after * 0.006) == std::lround(before));  // degrees
        } else {
          CHECK(is_same({before}, {after}));
        }
      }
    }
  }
  CHECK(std::isnan(column(all, "mine")[14]));
  CHECK(at<std::uint64_t>(out, 247) == 15);
  // Bounds and returns of what is there.
  double least = 1e99;
  for (const double x : column(all, "x")) least = std::min(least, x);
  CHECK(at<double>(out, 187) == least);
  std::uint64_t returns = 0;
  for (std::size_t i = 0; i < 15; ++i) returns += at<std::uint64_t>(out, 255 + 8 * i);
  std::uint64_t numbered = 0;
  for (const double number : column(all, "return_number")) numbered += number > 0;
  CHECK(returns == numbered);
}

TEST_CASE("LAS files that one LAS file cannot hold are an error before the work, with a way out",
          "[io][results]") {
  const auto error = [](const LasFile& a, const LasFile& b,
                        const std::function<void(std::string&)>& change = {}) {
    const ScratchFolder folder;
    std::string bytes = b.bytes();
    if (change) change(bytes);
    FileScan scan({folder.write("a.las", a.bytes()), folder.write("b.las", bytes)}, {});
    const std::string error =
        error_of([&] { check_output_folder(scan, las_config(), folder / "out", Overwrite::kOwn); });
    FilesConfig ply = las_config();
    ply.output.points_format = PointsFormat::kPly;
    CHECK(error_of([&] { check_output_folder(scan, ply, folder / "out", Overwrite::kOwn); }).empty());
    return error;
  };
  LasFile other = file_of(1, 2);
  CHECK(error(file_of(1, 2), other).empty());
  other.scale[0] = 0.0037;
  other.offset[0] = 499;
  CHECK_THAT(error(file_of(1, 2), other),
             Contains("b.las: coordinates with a scale") && Contains("--points-format ply"));
  CHECK_THAT(error(file_of(1, 2), file_of(1, 2), [](std::string& bytes) { put<std::uint16_t>(bytes, 6, 1); }),
             Contains("b.las: its GPS times are of another kind") && Contains("--points-format ply"));
  CHECK_THAT(error(file_of(4, 3), file_of(4, 3)),
             Contains("b.las: its waveforms") && Contains("--points-format ply"));
  LasFile far = file_of(1, 2);
  far.offset[0] = 1e9;
  CHECK_THAT(error(file_of(1, 2), far,
                   [](std::string& bytes) {
                     put<double>(bytes, 179, 1e9 + 1);
                     put<double>(bytes, 187, 1e9);
                   }),
             Contains("one LAS file cannot hold coordinates") && Contains("--points-format ply"));
}

TEST_CASE("offsets a part of a step apart get a finer scale, and every coordinate stays", "[io][results]") {
  const ScratchFolder folder;
  // In steps of 0.01, and the scale that both files then need. A thousandth of a step is none.
  for (const auto& [steps, scale] : std::vector<std::pair<double, double>>{
           {7, 0.01}, {0.5, 0.001}, {-2.25, 0.0001}, {1000.3, 0.001}, {3.002, 0.00001}, {3.0009, 0.01}}) {
    INFO(steps);
    LasFile a = file_of(1, 2), b = file_of(1, 2);
    for (LasFile* las : {&a, &b}) {
      for (std::size_t i = 0; i < 5; ++i) put(las->points[i], 0, static_cast<std::int32_t>(33 * i) - 66);
    }
    b.offset[0] = a.offset[0] + 0.01 * steps;
    const auto write = [&](const std::string& name, const LasFile& las) {
      std::string bytes = las.bytes();
      put<double>(bytes, 179, las.offset[0] + 0.66);
      put<double>(bytes, 187, las.offset[0] - 0.66);
      return ScanInput(folder.write(name, bytes));
    };
    const std::vector<ScanInput> inputs = {write("a.las", a), write("b.las", b)};
    const std::string out = join(folder, inputs);
    CHECK(at<double>(out, 131) == Approx(scale).epsilon(1e-12));
    const std::vector<double> joined = column(read_table(folder / "out" / "points.las"), "x");
    for (std::size_t i = 0; i < 10; ++i) {
      const double x = column(read_table(inputs[i / 5].file), "x")[i % 5];
      CHECK(std::abs(joined[i] - x) <= 1e-3 * scale + 2e-10);  // 2e-10: of doubles near 500,000
    }
  }
}

TEST_CASE("offsets that no scale brings together are an error, unless a pose moves one of the files",
          "[io][results]") {
  const ScratchFolder folder;
  LasFile a = file_of(1, 2), b = file_of(1, 2);
  for (LasFile* las : {&a, &b}) {
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        put(las->points[i], 4 * axis, static_cast<std::int32_t>(20'011 * i + 7 * axis));
    }
  }
  b.offset[0] = a.offset[0] + 0.02 / 3;
  const std::string first = folder.write("a.las", a.bytes()), second = folder.write("b.las", b.bytes());
  CHECK_THAT(error_of([&] {
               join(folder, {first, second});
             }),
             Contains("b.las: coordinates with a scale") && Contains("--points-format ply"));

  const std::string out = join(folder, {first, ScanInput(second, Pose::Identity())});
  const double step = at<double>(out, 131);
  CHECK(step == 0.001);  // 0.0067 is then seven steps, not six
  const std::vector<double> joined = column(read_table(folder / "out" / "points.las"), "x");
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(joined[i] == Approx(column(read_table(first), "x")[i]).epsilon(1e-15));
    CHECK(std::abs(joined[i + 5] - column(read_table(second), "x")[i]) <= step / 2 + 2e-10);
  }
}

}  // namespace lacuna::test
