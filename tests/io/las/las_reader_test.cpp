// SPDX-License-Identifier: Apache-2.0
#include "io/las/las_reader.hpp"

#include "io/formats.hpp"
#include "io/las/las_header.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

double value(const Table& table, std::size_t row, const std::string& column) {
  return table.rows.at(row).at(table.place(column));
}

TEST_CASE("the coordinate reference system comes from records before the points or behind them", "[io]") {
  const ScratchFolder folder;
  const std::string name("GEOGCS[\"B\"]");
  LasFile before{.points = {las_point(20, 1, 2, 3)}, .records = {las_record("LASF_Projection", 2112, name)}};
  CHECK(open_scan(folder.write("before.las", before.bytes()), {})->crs() == name);
  before.records = {las_record("other", 2112, name)};
  CHECK(open_scan(folder.write("other.las", before.bytes()), {})->crs().empty());

  std::string behind = LasFile{.minor = 4, .points = {las_point(20, 1, 2, 3)}}.bytes();
  put(behind, 235, static_cast<std::uint64_t>(behind.size()));
  put<std::uint32_t>(behind, 243, 2);
  for (const std::string user : {"other", "LASF_Projection"}) {
    std::string head(60, '\0');
    std::memcpy(&head[2], user.data(), user.size());
    put<std::uint16_t>(head, 18, 2112);
    put<std::uint64_t>(head, 20, name.size());
    behind += head + name;
  }
  const auto file = folder.write("behind.las", behind);
  CHECK(open_scan(file, {})->crs() == name);
  CHECK(read_table(file).rows.size() == 1);
  behind.pop_back();
  CHECK_THAT(read_error(folder.write("cut.las", behind)),
             Contains("an extended record of 11 bytes goes on beyond the end of the file"));
}

TEST_CASE("coordinates of LAS are stored numbers times scale plus offset", "[io]") {
  const ScratchFolder folder;
  LasFile las;
  las.points = {las_point(20, 1, 2, 3), las_point(20, -2147483648, 2147483647, 0)};
  const Table table = read_table(folder.write("a.las", las.bytes()));
  REQUIRE(table.rows.size() == 2);
  CHECK(value(table, 0, "x") == 1 * 0.01 + 500'000);
  CHECK(value(table, 0, "z") == 3 * 0.001);
  CHECK(value(table, 1, "x") == -2147483648.0 * 0.01 + 500'000);
  CHECK(value(table, 1, "y") == 2147483647.0 * 0.01 + 5'400'000);
}

TEST_CASE("every field of every point format of LAS is a column", "[io]") {
  const ScratchFolder folder;
  constexpr std::array<std::size_t, 11> kBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  for (int format = 0; format <= 10; ++format) {
    INFO("format " << format);
    const std::size_t bytes = las_point_bytes(format);
    CHECK(bytes == kBytes.at(static_cast<std::size_t>(format)));
    std::string p = las_point(bytes, 1, 2, 3);
    put<std::uint16_t>(p, 12, 65'535);
    std::size_t next = 20;
    if (format < 6) {
      put<std::uint8_t>(p, 14, 0b1'0'011'010);
      put<std::uint8_t>(p, 15, 0b1'0'1'00110);
      put<std::int8_t>(p, 16, -90);
      put<std::uint8_t>(p, 17, 200);
      put<std::uint16_t>(p, 18, 4000);
      if (format == 1 || format >= 3) {
        put(p, next, 123456.789);
        next += 8;
      }
    } else {
      put<std::uint8_t>(p, 14, 0b1100'1011);
      put<std::uint8_t>(p, 15, 0b1'0'10'1'0'1'1);
      put<std::uint8_t>(p, 16, 64);
      put<std::uint8_t>(p, 17, 200);
      put<std::int16_t>(p, 18, -15'000);
      put<std::uint16_t>(p, 20, 4000);
      put(p, 22, 123456.789);
      next = 30;
    }
    const bool has_colour =
        format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
    if (has_colour) {
      for (std::uint16_t colour : {1000, 2000, 3000}) {
        put(p, next, colour);
        next += 2;
      }
    }
    if (format == 8 || format == 10) {
      put<std::uint16_t>(p, next, 777);
      next += 2;
    }
    const bool has_wave = format == 4 || format == 5 || format >= 9;
    if (has_wave) {
      put<std::uint8_t>(p, next, 9);
      put<std::uint64_t>(p, next + 1, 1'000'000'000'000);
      put<std::uint32_t>(p, next + 9, 256);
      put(p, next + 13, 1.5f);
      for (int axis = 0; axis < 3; ++axis)
        put(p, next + 17 + 4 * static_cast<std::size_t>(axis), 0.25f * static_cast<float>(axis + 1));
      next += 29;
    }
    REQUIRE(next == bytes);

    LasFile las{.minor = format < 6 ? 3 : 4, .format = format, .points = {p, p}, .records = {}};
    const Table table = read_table(folder.write("a.las", las.bytes()));
    REQUIRE(table.rows.size() == 2);
    CHECK(value(table, 1, "intensity") == 65'535);
    CHECK(value(table, 1, "user_data") == 200);
    CHECK(value(table, 1, "point_source_id") == 4000);
    CHECK(value(table, 1, "return_number") == (format < 6 ? 2 : 11));
    CHECK(value(table, 1, "number_of_returns") == (format < 6 ? 3 : 12));
    CHECK(value(table, 1, "scan_direction_flag") == 0);
    CHECK(value(table, 1, "edge_of_flight_line") == 1);
    CHECK(value(table, 1, "classification") == (format < 6 ? 6 : 64));
    CHECK(value(table, 1, "synthetic") == 1);
    CHECK(value(table, 1, "key_point") == (format < 6 ? 0 : 1));
    CHECK(value(table, 1, "withheld") == (format < 6 ? 1 : 0));
    CHECK(value(table, 1, "scan_angle") == (format < 6 ? -90 : -15'000));
    if (format >= 6) {
      CHECK(value(table, 1, "overlap") == 1);
      CHECK(value(table, 1, "scanner_channel") == 2);
    }
    if (format != 0 && format != 2) CHECK(value(table, 1, "gps_time") == 123456.789);
    if (has_colour) CHECK(value(table, 1, "blue") == 3000);
    if (format == 8 || format == 10) CHECK(value(table, 1, "nir") == 777);
    if (has_wave) {
      CHECK(value(table, 1, "wave_packet_offset") == 1e12);
      CHECK(value(table, 1, "wave_packet_bytes") == 256);
      CHECK(value(table, 1, "wave_return_location") == 1.5);
      CHECK(value(table, 1, "wave_z") == 0.75);
    }
  }
}

TEST_CASE("extra bytes of LAS are columns by their descriptors, others by their place", "[io]") {
  const ScratchFolder folder;
  std::string p = las_point(20 + 2 + 4 + 12 + 3 + 8 + 2, 1, 2, 3);
  put<std::int16_t>(p, 20, -300);
  put<float>(p, 22, 2.5f);
  for (std::size_t i = 0; i < 3; ++i) put<std::int32_t>(p, 26 + 4 * i, static_cast<std::int32_t>(i) + 7);
  for (std::size_t i = 0; i < 3; ++i) put<std::uint8_t>(p, 38 + i, static_cast<std::uint8_t>(i) + 1);
  put<std::uint64_t>(p, 41, 1ull << 40);
  put<std::uint8_t>(p, 49, 5);
  put<std::uint8_t>(p, 50, 6);
  LasFile las{.points = {p}};
  las.records = {las_record("other", 4, "nothing"),
                 las_record("LASF_Spec", 4,
                            las_extra_descriptor("height above", 4, 8 + 16, 0.5, 100) +
                                las_extra_descriptor("width", 9) + las_extra_descriptor("normal", 26) +
                                las_extra_descriptor("raw", 0, 3) + las_extra_descriptor("x", 7))};
  const Table table = read_table(folder.write("a.las", las.bytes()));
  REQUIRE(table.rows.size() == 1);
  CHECK(value(table, 0, "height_above") == -50);
  CHECK(value(table, 0, "width") == 2.5);
  CHECK(value(table, 0, "normal_0") == 7);
  CHECK(value(table, 0, "normal_2") == 9);
  CHECK(value(table, 0, "raw_2") == 3);
  CHECK(value(table, 0, "x_2") == static_cast<double>(1ull << 40));
  CHECK(value(table, 0, "extra_0") == 5);
  CHECK(value(table, 0, "extra_1") == 6);
}

TEST_CASE("records of extra bytes are joined in order where they fit a point, else the last one holds",
          "[io]") {
  const ScratchFolder folder;
  std::string point = las_point(20 + 4 + 1, 1, 2, 3);
  put<float>(point, 20, 2.5f);
  put<std::uint8_t>(point, 24, 7);
  const std::string a = las_record("LASF_Spec", 4, las_extra_descriptor("a", 9)),
                    bad = las_record("LASF_Spec", 4, las_extra_descriptor("bad", 1)),
                    all = las_record("LASF_Spec", 4,
                                     las_extra_descriptor("a", 9) + las_extra_descriptor("bad", 1));
  const auto open = [&](const std::vector<std::string>& records) {
    return folder.write("a.las", LasFile{.points = {point}, .records = records}.bytes());
  };
  for (const auto& records : {std::vector{a, bad}, {a, bad, a}, {all, all}, {all}}) {
    const auto file = open(records);
    const Table table = read_table(file);
    CHECK(value(table, 0, "a") == 2.5);
    CHECK(value(table, 0, "bad") == 7);
    CHECK(open_scan(file, {})->notes()[0].count == 0);
  }
  const auto file = open({a, all});
  CHECK(value(read_table(file), 0, "bad") == 7);
  CHECK(open_scan(file, {})->notes()[0].count == 2);
}

TEST_CASE("extra bytes of LAS without a name, or with the name of others, have names of their own", "[io]") {
  const ScratchFolder folder;
  std::string descriptors;
  for (const char* name : {"", "x_2", "x", ""}) descriptors += las_extra_descriptor(name, 1);
  const LasFile las{.points = {las_point(20 + 5, 1, 2, 3)},
                    .records = {las_record("LASF_Spec", 4, descriptors)}};
  const std::vector<std::string> names = read_table(folder.write("a.las", las.bytes())).names;
  CHECK(std::vector<std::string>(names.end() - 5, names.end()) ==
        std::vector<std::string>{"extra", "x_2", "x_3", "extra_2", "extra_0"});
}

TEST_CASE("LAS with the longest points: batches are bounded in bytes, and columns are named at once",
          "[io]") {
  const ScratchFolder folder;
  constexpr std::size_t kPoints = 600;
  const LasFile las{.points = std::vector<std::string>(kPoints, las_point(65'535, 1, 2, 3))};
  const std::clock_t begin = std::clock();  // of the processor: other work does not count
  const auto reader = open_scan(folder.write("a.las", las.bytes()), {});
  CHECK(std::clock() - begin < 3 * CLOCKS_PER_SEC);
  CHECK(reader->layout().properties.back().name == "extra_65514");
  RowBatch batch;
  std::size_t rows = 0;
  while (reader->next(batch, 65'536)) {
    CHECK(batch.bytes.size() <= 32u << 20);
    rows += batch.count;
  }
  CHECK(rows == kPoints);
}

LasFile small_file() {
  LasFile las{.minor = 4, .format = 7};
  for (int i = 0; i < 3; ++i) las.points.push_back(las_point(36 + 4, i, 2 * i, 3 * i));
  las.records = {las_record("LASF_Spec", 4, las_extra_descriptor("width", 9))};
  return las;
}

TEST_CASE("what follows the points of LAS is passed over, where it is shorter than a point", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.las", small_file().bytes() + "some padding")).rows.size() == 3);
}

TEST_CASE("a LAS header that counts others than the points that follow is an error, unless one is trusted",
          "[io]") {
  const ScratchFolder folder;
  const auto bytes = [](std::uint64_t counted, std::size_t cut) {
    std::string bytes = small_file().bytes();
    put(bytes, 247, counted);
    put(bytes, 107, static_cast<std::uint32_t>(counted));
    return bytes.substr(0, bytes.size() - cut);
  };
  const auto rows = [&](std::uint64_t counted, std::size_t cut, Trust trust) {
    return read_table(folder.write("a.las", bytes(counted, cut)), 1000, {.trust = trust}).rows.size();
  };
  check_refused("a.las", {{bytes(2, 0), "the header counts 2 points, but 3 whole ones of 40 bytes follow"},
                          {bytes(2, 0), "--trust file reads these, --trust header the others"},
                          {bytes(0, 0), "the header counts 0 points, but 3 whole ones"},
                          {bytes(3, 1), "the header counts 3 points, but 2 whole ones"}});
  CHECK(rows(2, 0, Trust::kHeader) == 2);
  CHECK(rows(2, 0, Trust::kFile) == 3);
  CHECK(rows(0, 0, Trust::kFile) == 3);
  CHECK(rows(3, 1, Trust::kFile) == 2);
  CHECK_THAT(error_of([&] { rows(3, 1, Trust::kHeader); }), Contains("the header declares 3 points"));
}

TEST_CASE("what is wrong with a LAS file is said with its place", "[io]") {
  const auto with = [whole = small_file().bytes()](std::size_t offset, auto value) {
    std::string changed = whole;
    put(changed, offset, value);
    return changed;
  };
  const std::string many = with(247, std::uint64_t{1} << 60);
  check_refused("a.las", {{with(25, std::uint8_t{6}), "byte 24: LAS 1.6; versions 1.0 to 1.5 are read"},
                          {with(104, std::uint8_t{11}), "byte 104: point format 11; formats 0 to 10"},
                          {with(105, std::uint16_t{35}), "points of 35 bytes; those of format 7 have 36"},
                          {many, "the header counts 1152921504606846976 points, but 3 whole ones of 40"},
                          {many, "--trust file"},
                          {with(131, 0.0), "byte 131: a scale that is 0"},
                          {with(96, std::uint32_t{100}), "the points begin within the header"},
                          {with(100, std::uint32_t{7}), "7 variable length records do not fit"}});
}

}  // namespace
}  // namespace lacuna::test
