// SPDX-License-Identifier: Apache-2.0
// The annotated scan as LAZ: the same records as in LAS, in a file that other programs read.
#include "engine/run/parallel.hpp"
#include "io/read/las/las_points.hpp"
#include "io/read/laz/laz.hpp"
#include "io/write/results/points.hpp"
#include "tests/io/results/points_las_support.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
using namespace io;

namespace {

std::string records_of(const fs::path& file) {
  InputFile in(file);
  const LasHeader header = read_las_header(in);
  const auto points = las_points(in, header, Trust::kNeither, std::uint64_t{1} << 30);
  std::string records(header.points * header.record_bytes, '\0');
  points->read(std::as_writable_bytes(std::span(records)));
  return records;
}

// The annotated file of one file, with five points.
fs::path write_points(const ScratchFolder& folder, const fs::path& file) {
  const ScanFiles scan({file}, {});
  write_results(FakeDetection().with_results(5), scan, with_points(), folder / "out");
  const auto points = folder / "out" / "points";
  return fs::directory_iterator(points)->path();
}

// The points as LAZ, in blocks that do not end where chunks do.
fs::path compress(const ScratchFolder& folder, int format, const laz::Layout& layout,
                  const std::string& points, std::uint64_t memory) {
  LasFile empty{.minor = 4, .format = format};
  empty.points = {std::string(las_point_bytes(format), '\0')};
  const fs::path origin = folder.write("origin.las", empty.bytes());
  const auto file = folder / "a.laz";
  fs::remove(file);
  InputFile in(origin);
  const LasHeader header = read_las_header(in);
  OutputFile out(file, file);
  const std::size_t bytes = layout.record_bytes();
  LasWriter writer(out, origin, header, {}, bytes, LasCompression{.layout = layout, .memory = memory});
  const auto records = std::as_bytes(std::span(points));
  for (std::size_t at = 0; at < records.size(); at += 7'001 * bytes)
    writer.put_rows(records.subspan(at, std::min(7'001 * bytes, records.size() - at)));
  writer.finish();
  out.close();
  return file;
}

std::string alike_points(std::size_t count, std::size_t bytes) {
  std::string all;
  for (const std::string& point : las_points_alike(bytes, count)) all += point;
  return all;
}

std::string laz_bytes(const LasFile& las) {
  const auto extra = static_cast<std::uint16_t>(las.points[0].size() - las_point_bytes(las.format));
  return laz_file(las, laz::layout_of(las.format, extra), {las.points.size()});
}

}  // namespace

TEST_CASE("the annotated LAZ file has the records of a LAS file, and its header but for how they are stored",
          "[io][results]") {
  for (const int format : {0, 1, 2, 3, 6, 7, 8}) {
    INFO("point format " << format);
    const ScratchFolder folder;
    LasFile las = file_of(format, format < 6 ? 2 : 4, 2 + 8 + 3);
    las.records = {
        las_record("kept", 1, "kept"),
        las_record("LASF_Spec", 4, las_extra_descriptor("height", 3) + las_extra_descriptor("pulse", 8))};
    std::string plain_bytes = las.bytes(), packed = laz_bytes(las);
    if (format >= 6) {
      const std::string record = las_extended_record("somebody", 78, std::string(100'000, 'x'));
      plain_bytes = with_extended(plain_bytes, {record});
      packed = with_extended(packed, {record});
    }
    const ScratchFolder other;
    const auto plain_file = write_points(folder, folder.write("a.las", plain_bytes));
    const auto laz_file = write_points(other, other.write("b.laz", packed));
    REQUIRE(plain_file.filename() == "a.las");
    REQUIRE(laz_file.filename() == "b.laz");
    const std::string plain = read_file(plain_file), laz = read_file(laz_file);
    CHECK((records_of(laz_file) == records_of(plain_file)));

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
    const auto twice = write_points(again, laz_file);
    CHECK(twice.filename() == "b.laz");
    CHECK((read_file(twice) == laz));
  }
}

TEST_CASE("compressed points are read as they were written, for every number of chunks", "[io][results]") {
  const ScratchFolder folder;
  for (const int format : {0, 3, 6, 8}) {
    const std::size_t record = las_point_bytes(format) + 2;
    const laz::Layout layout = laz::layout_of(format, 2);
    REQUIRE(layout.chunk_points == 50'000);
    for (const std::size_t count : {0u, 1u, 49'999u, 50'000u, 50'001u, 130'000u}) {
      INFO("point format " << format << ", " << count << " points");
      const std::string points = alike_points(count, record);
      std::string one;
      for (const std::size_t threads : {1u, 2u, 8u}) {
        for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
          fs::path file;
          TaskArena(threads).for_each(
              1, [&](std::size_t) { file = compress(folder, format, layout, points, memory); });
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
    const laz::Layout layout = laz::layout_of(format, kExtra);
    CHECK(layout.chunk_points == (std::size_t{4} << 20) / layout.record_bytes());
    const std::string points = alike_points(1'000, layout.record_bytes());
    const auto file = compress(folder, format, layout, points, 0);
    CHECK((records_of(file) == points));
  }
}

TEST_CASE("annotated LAZ refuses points too long for the memory limit before the work", "[io][results]") {
  const ScratchFolder folder;
  const auto refusal = [&](const LasFile& las, std::uint64_t memory) {
    const ScanFiles scan({folder.write("b.laz", laz_bytes(las))}, {}, memory);
    return error_of([&] { check_points(scan, with_points()); });
  };
  constexpr std::uint64_t kMuch = std::uint64_t{1} << 30, kLittle = std::uint64_t{6} << 20;
  const LasFile wide = file_of(1, 4, 3'000);
  CHECK(refusal(wide, kMuch).empty());
  CHECK_THAT(refusal(wide, kLittle), Contains("points/b.laz: to compress points of 3050 bytes takes ") &&
                                         Contains("more than the 6 MiB that the memory limit leaves for it; "
                                                  "--points-format ply holds them all"));
}

}  // namespace lacuna::test
