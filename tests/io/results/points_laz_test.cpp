// SPDX-License-Identifier: Apache-2.0
// The annotated scan as LAZ: the same records as in points.las, in a file that other programs read.
#include "engine/run/parallel.hpp"
#include "io/las/las_points.hpp"
#include "io/las/las_writer.hpp"
#include "io/laz/laz_encoder.hpp"
#include "io/results/points.hpp"
#include "tests/io/results/points_las_support.hpp"

namespace lacuna::test {
using namespace io;

using Catch::Matchers::Contains;

namespace {

std::string records_of(const std::filesystem::path& file) {
  InputFile in(file);
  const LasHeader header = read_las_header(in);
  const auto points = las_points(in, header, std::uint64_t{1} << 30);
  std::string records(header.points * header.record_bytes, '\0');
  points->read(std::as_writable_bytes(std::span(records)));
  return records;
}

// The annotated scan of this format, in a folder "out".
std::filesystem::path write_points(const ScratchFolder& folder, const std::vector<ScanInput>& inputs,
                                   std::size_t rows, PointsFormat format) {
  FilesConfig config = las_config();
  config.output.points_format = format;
  FileScan scan(inputs, {});
  write_results(FakeDetection().with_results(rows), scan, config, folder / "out");
  return folder / "out" / points_file(scan, config.output);
}

LasForm form_of(int format, std::size_t record_bytes) {
  LasForm form;
  form.point_format = format;
  form.scale = {0.01, 0.01, 0.01};
  form.record_bytes = record_bytes;
  return form;
}

// Points of which a few bytes differ from one to the next.
std::string alike_points(std::size_t count, std::size_t bytes) {
  std::mt19937 random(3);
  std::string points = las_point(bytes, 1000, 2000, 300);
  points.reserve(count * bytes);
  for (std::size_t i = 1; i < count; ++i) {
    points += points.substr(points.size() - bytes);
    points[points.size() - 1 - random() % bytes] = static_cast<char>(random());
  }
  return points.substr(0, count * bytes);
}

}  // namespace

TEST_CASE("points.laz has the records of points.las, and its header but for what says how they are stored",
          "[io][results]") {
  for (const int format : {0, 1, 2, 3, 6, 7, 8}) {
    INFO("point format " << format);
    const ScratchFolder folder;
    LasFile las = file_of(format, format < 6 ? 2 : 4, 2 + 8 + 3);
    las.records = {
        las_record("kept", 1, "kept"),
        las_record("LASF_Spec", 4, las_extra_descriptor("height", 3) + las_extra_descriptor("pulse", 8))};
    std::string bytes = las.bytes();
    if (format >= 6) {
      put<std::uint64_t>(bytes, 235, bytes.size());
      put<std::uint32_t>(bytes, 243, 1);
      bytes += extended_record("somebody", 78, std::string(100'000, 'x'));
    }
    const auto file = folder.write("a.las", bytes);
    const auto plain_file = write_points(folder, {file}, 5, PointsFormat::kInput);
    REQUIRE(plain_file.filename() == "points.las");
    const std::string records = records_of(plain_file), plain = read_file(plain_file);
    const auto laz_file = write_points(folder, {file}, 5, PointsFormat::kLaz);
    REQUIRE(laz_file.filename() == "points.laz");
    const std::string laz = read_file(laz_file);
    CHECK((records_of(laz_file) == records));

    // The format's bit, where the points begin, the number of records, where the extended ones begin.
    std::string header = plain.substr(0, 375);
    put(header, 96, at<std::uint32_t>(laz, 96));
    put(header, 100, at<std::uint32_t>(plain, 100) + 1);
    put(header, 104, static_cast<std::uint8_t>(format | 0x80));
    put(header, 235, at<std::uint64_t>(laz, 235));
    CHECK((laz.substr(0, 375) == header));
    const std::size_t points_at = at<std::uint32_t>(laz, 96), plain_at = at<std::uint32_t>(plain, 96);
    CHECK((laz.substr(375, plain_at - 375) == plain.substr(375, plain_at - 375)));
    CHECK(laz.substr(plain_at + 2, 14) == "laszip encoded");
    if (format >= 6) {
      const std::size_t extended_at = at<std::uint64_t>(laz, 235);
      CHECK(extended_at > points_at);
      CHECK((laz.substr(extended_at) == plain.substr(at<std::uint64_t>(plain, 235))));
    }

    // What came as LAZ goes out as LAZ. The next run replaces the results, not more.
    const ScratchFolder again;
    const auto twice = write_points(again, {laz_file}, 5, PointsFormat::kInput);
    CHECK(twice.filename() == "points.laz");
    CHECK((read_file(twice) == laz));
  }
}

TEST_CASE("compressed points are read as they were written, for every number of chunks", "[io][results]") {
  const ScratchFolder folder;
  for (const int format : {0, 3, 6, 8}) {
    const std::size_t record = las_point_bytes(format) + 2;
    const laz::Layout layout = laz::layout_of(format, 2).value();
    REQUIRE(layout.chunk_points == 50'000);
    for (const std::size_t count : {0u, 1u, 49'999u, 50'000u, 50'001u, 130'000u}) {
      INFO("point format " << format << ", " << count << " points");
      const std::string points = alike_points(count, record);
      std::string one;
      for (const std::size_t threads : {1u, 2u, 8u}) {
        for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
          const auto file = folder / "a.laz";
          std::filesystem::remove(file);
          TaskArena(threads).for_each(1, [&](std::size_t) {
            OutputFile out(file, file);
            LasWriter writer(out, form_of(format, record), {}, {}, {},
                             LasCompression{.layout = layout, .memory = memory});
            // Blocks that do not end where chunks do.
            const auto records = std::as_bytes(std::span(points));
            for (std::size_t at = 0; at < records.size(); at += 7'001 * record)
              writer.put(records.subspan(at, std::min(7'001 * record, records.size() - at)));
            writer.finish();
            out.close();
          });
          const std::string bytes = read_file(file);
          if (one.empty()) {
            one = bytes;
            CHECK((records_of(file) == points));
          }
          CHECK((bytes == one));
        }
      }
    }
  }
}

TEST_CASE("chunks of long points have fewer of them, and are read as they were written", "[io][results]") {
  const ScratchFolder folder;
  constexpr std::uint16_t kExtra = 9'000;
  for (const int format : {1, 6}) {
    const laz::Layout layout = laz::layout_of(format, kExtra).value();
    CHECK(layout.chunk_points == (std::size_t{4} << 20) / layout.record_bytes());
    const std::string points = alike_points(1'000, layout.record_bytes());
    const auto file = folder / "a.laz";
    std::filesystem::remove(file);
    OutputFile out(file, file);
    LasWriter writer(out, form_of(format, layout.record_bytes()), {}, {}, {},
                     LasCompression{.layout = layout, .memory = 0});
    writer.put(std::as_bytes(std::span(points)));
    writer.finish();
    out.close();
    CHECK((records_of(file) == points));
  }
}

TEST_CASE("points.laz refuses waveforms and points too long for the memory limit before the work",
          "[io][results]") {
  const ScratchFolder folder;
  FilesConfig config = las_config();
  config.output.points_format = PointsFormat::kLaz;
  const auto refusal = [&](const std::string& file, std::uint64_t memory) {
    const FileScan scan({file}, {}, memory);
    return error_of([&] { check_points(scan, config.output); });
  };
  constexpr std::uint64_t kMuch = std::uint64_t{1} << 30, kLittle = std::uint64_t{11} << 20;
  for (const int format : {4, 5, 9, 10}) {
    const std::string file = folder.write("waves.las", file_of(format, 4).bytes());
    CHECK(refusal(file, kMuch) == "points.laz: points of format " + std::to_string(format) +
                                      " have waveforms, which Lacuna cannot compress; --points-format las "
                                      "holds them all");
  }
  const std::string wide = folder.write("wide.las", file_of(6, 4, 3'000).bytes());
  CHECK(refusal(wide, kMuch).empty());
  CHECK_THAT(refusal(wide, kLittle), Contains("points.laz: to compress points of 3052 bytes takes ") &&
                                         Contains("more than the 11 MiB that the memory limit leaves for it; "
                                                  "--points-format las holds them all"));
  CHECK(refusal(folder.write("short.las", file_of(8, 4, 40).bytes()), kLittle).empty());
}

TEST_CASE("LAZ and LAS files together become points.las, and points.laz if it is wanted", "[io][results]") {
  const ScratchFolder folder;
  const auto las = folder.write("a.las", file_of(3, 2).bytes());
  const auto laz = folder / "b.laz";
  std::filesystem::rename(write_points(folder, {las}, 5, PointsFormat::kLaz), laz);
  const auto other = folder.write("c.las", file_of(8, 4, 0, 2).bytes());
  CHECK(write_points(folder, {laz, laz}, 10, PointsFormat::kInput).filename() == "points.laz");
  const auto plain = write_points(folder, {laz, other}, 10, PointsFormat::kInput);
  REQUIRE(plain.filename() == "points.las");
  const std::string records = records_of(plain);
  CHECK((records_of(write_points(folder, {laz, other}, 10, PointsFormat::kLaz)) == records));
}

}  // namespace lacuna::test
