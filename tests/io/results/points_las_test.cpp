// SPDX-License-Identifier: Apache-2.0
// The annotated scan as LAS and as LAZ, with the same records, in files that other programs read.
#include "engine/run/parallel.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/las/las_points.hpp"
#include "io/read/laz/laz.hpp"
#include "io/write/results/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

constexpr std::size_t kResultBytes = 4 * 4 + 1 + 1 + 4;

// Records of random bytes: every field has values, and every bit is there.
std::vector<std::string> random_points(std::size_t count, std::size_t bytes, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<std::string> points;
  for (std::size_t i = 0; i < count; ++i) {
    std::string point = las_point(bytes, 0, 0, 0);
    for (std::size_t b = 0; b < bytes; ++b) point[b] = static_cast<char>(random());
    points.push_back(point);
  }
  return points;
}

LasFile file_of(int format, int minor, std::size_t extra_bytes = 0, unsigned seed = 1) {
  return {.minor = minor,
          .format = format,
          .points = random_points(5, io::las_point_bytes(format) + extra_bytes, seed),
          .records = {}};
}

std::string detect_to(const ScratchFolder& folder, const io::ScanFiles& scan, std::size_t rows,
                      const io::FilesConfig& config) {
  io::write_results(FakeDetection().with_results(rows), scan, config, folder / "out");
  return read_file(folder / "out" / "points" / "a.las");
}

// The bytes of point i, without results.
std::string point_of(const std::string& las, std::size_t i, std::size_t bytes) {
  const std::size_t record = at<std::uint16_t>(las, 105);
  return las.substr(at<std::uint32_t>(las, 96) + i * record, bytes);
}

void check_columns(const Table& input, const Table& output) {
  for (const std::string& name : input.names) {
    INFO(name);
    CHECK(same_numbers(input.column(name), output.column(name)));
  }
}

}  // namespace

using namespace io;

TEST_CASE("the annotated LAS file has every byte of the points, records and header of a LAS file",
          "[io][results]") {
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
      const std::string extended = las_extended_record("somebody", 78, std::string(100'000, 'x'));
      if (minor == 4) {
        bytes = with_extended(bytes, {extended, las_extended_record("copc", 1000, "gone"),
                                      las_extended_record("LASF_Spec", 65535, "waves")});
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

      const ScanFiles scan({folder.write("a.las", bytes)}, {});
      const std::string out = detect_to(folder, scan, 5, with_points());
      CHECK(out.substr(0, 4) == "LASF");
      CHECK(out.substr(4, 20) == bytes.substr(4, 20));
      CHECK(out.substr(24, 2) == "\1\4");
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
        CHECK(out.substr(end) == extended + las_extended_record("LASF_Spec", 65535, "waves"));
        CHECK(at<std::uint64_t>(out, 227) == end + extended.size());
      } else {
        CHECK(out.size() == end);
        CHECK(at<std::uint32_t>(out, 243) == 0);
      }
      const Table written = read_table(folder / "out" / "points" / "a.las");
      check_columns(read_table(folder / "a.las"), written);
      CHECK(written.column("probability") == std::vector<double>{0, 1, 2, 3, 4});

      // The next run replaces the results, not more.
      const ScratchFolder again;
      const ScanFiles second({folder / "out" / "points" / "a.las"}, {});
      const std::string twice = detect_to(again, second, 5, with_points());
      CHECK((twice == out));
    }
  }
}

TEST_CASE("the annotated LAS file has the points that --trust chooses, and its header counts them",
          "[io][results]") {
  for (const int format : {1, 6}) {
    for (const auto& [counted, trust, rows] :
         {std::tuple(8u, Trust::kFile, 5u), {3u, Trust::kFile, 5u}, {3u, Trust::kHeader, 3u}}) {
      INFO("format " << format << ", counted " << counted << ", rows " << rows);
      const ScratchFolder folder;
      LasFile las = file_of(format, 4);
      for (std::string& point : las.points) point[14] = 2;  // return number
      std::string bytes = las.bytes();
      put<std::uint32_t>(bytes, 107, counted);
      put<std::uint64_t>(bytes, 247, counted);
      FilesConfig config = with_points();
      config.input.trust = trust;
      const ScanFiles scan({folder.write("a.las", bytes)}, config.input);
      const std::string out = detect_to(folder, scan, rows, config);
      CHECK(at<std::uint64_t>(out, 247) == rows);
      CHECK(at<std::uint64_t>(out, 255 + 8) == (rows == counted ? 0 : rows));
      CHECK(at<std::uint32_t>(out, 107) == (format < 6 || rows == counted ? rows : 0));
      check_columns(read_table(folder / "a.las", 1000, {.trust = trust}),
                    read_table(folder / "out" / "points" / "a.las"));
    }
  }
}

TEST_CASE("extra bytes of another program with the name of a result stay", "[io][results]") {
  const ScratchFolder folder;
  LasFile las = file_of(6, 4, 1);
  las.records = {las_record("LASF_Spec", 4, las_extra_descriptor("probability", 1))};
  const ScanFiles scan({folder.write("a.las", las.bytes())}, {});
  detect_to(folder, scan, 5, with_points());
  const Table table = read_table(folder / "out" / "points" / "a.las");
  CHECK(table.column("probability") == read_table(folder / "a.las").column("probability"));
  CHECK(table.column("lacuna_probability") == std::vector<double>{0, 1, 2, 3, 4});
}

TEST_CASE("damaged LAS files are errors for the annotated scan, or read as they are, and never more",
          "[io][results]") {
  const ScratchFolder folder;
  LasFile las = file_of(3, 4, 4);
  las.records = {las_record("LASF_Spec", 4, las_extra_descriptor("depth", 9)),
                 las_record("other", 1, "data")};
  const std::string bytes = with_extended(las.bytes(), {las_extended_record("other", 2, "more data")});
  std::mt19937 random(7);
  for (int i = 0; i < 120; ++i) {
    std::string damaged = bytes;
    const std::size_t place = 24 + random() % (damaged.size() - 24);
    damaged[place] = static_cast<char>(random());
    const auto file = folder.write("a.las", damaged);
    error_of([&] {
      const ScanFiles scan({file}, {});
      const std::uint64_t rows = scan.expected_points().value_or(0);
      if (rows > 100) return;
      detect_to(folder, scan, rows, with_points());
      check_columns(read_table(file), read_table(folder / "out" / "points" / "a.las"));
    });
  }
}

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
