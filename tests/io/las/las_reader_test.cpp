#include "io/las/las_reader.hpp"

#include "io/las/las_header.hpp"
#include "tests/io/io_support.hpp"

#include <array>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::test {
namespace {

using Catch::Matchers::Contains;

template <class T>
void put(std::string& bytes, std::size_t offset, T value) {
  if (bytes.size() < offset + sizeof value) bytes.resize(offset + sizeof value);
  std::memcpy(&bytes[offset], &value, sizeof value);
}

std::string record(const std::string& user, std::uint16_t number, const std::string& data) {
  std::string bytes(54, '\0');
  std::memcpy(&bytes[2], user.data(), user.size());
  put<std::uint16_t>(bytes, 18, number);
  put<std::uint16_t>(bytes, 20, static_cast<std::uint16_t>(data.size()));
  return bytes + data;
}

std::string extra_descriptor(const std::string& name, std::uint8_t type, std::uint8_t options = 0,
                             double scale = 0, double offset = 0) {
  std::string bytes(192, '\0');
  put(bytes, 2, type);
  put(bytes, 3, options);
  std::memcpy(&bytes[4], name.data(), name.size());
  put(bytes, 112, scale);
  put(bytes, 136, offset);
  return bytes;
}

struct LasFile {
  int minor = 2;
  int format = 0;
  std::vector<std::string> points;  // records
  std::vector<std::string> records;
  std::array<double, 3> scale{0.01, 0.01, 0.001}, offset{500'000, 5'400'000, 0};

  std::string bytes() const {
    constexpr std::array<std::uint16_t, 5> kHeader = {227, 227, 227, 235, 375};
    std::string file(kHeader.at(static_cast<std::size_t>(minor)), '\0');
    const auto header_bytes = static_cast<std::uint16_t>(file.size());
    std::memcpy(file.data(), "LASF", 4);
    put<std::uint8_t>(file, 24, 1);
    put(file, 25, static_cast<std::uint8_t>(minor));
    put(file, 94, header_bytes);
    put(file, 100, static_cast<std::uint32_t>(records.size()));
    put(file, 104, static_cast<std::uint8_t>(format));
    put(file, 105, static_cast<std::uint16_t>(points.empty() ? 20 : points[0].size()));
    const bool is_long = minor == 4;
    put(file, 107, static_cast<std::uint32_t>(is_long ? 0 : points.size()));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(file, 131 + 8 * axis, scale[axis]);
      put(file, 155 + 8 * axis, offset[axis]);
    }
    if (is_long) put(file, 247, static_cast<std::uint64_t>(points.size()));
    for (const std::string& r : records) file += r;
    put(file, 96, static_cast<std::uint32_t>(file.size()));
    for (const std::string& p : points) file += p;
    return file;
  }
};

std::string point(std::size_t bytes, std::int32_t x, std::int32_t y, std::int32_t z) {
  std::string record(bytes, '\0');
  put(record, 0, x);
  put(record, 4, y);
  put(record, 8, z);
  return record;
}

double value(const Table& table, std::size_t row, const std::string& column) {
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (table.names[i] == column) return table.rows.at(row).at(i);
  }
  FAIL("no column " << column);
  return 0;
}

TEST_CASE("the coordinate reference system comes from records before the points or behind them", "[io]") {
  const ScratchFolder folder;
  const std::string name("GEOGCS[\"B\"]");
  LasFile before{.points = {point(20, 1, 2, 3)}, .records = {record("LASF_Projection", 2112, name)}};
  CHECK(open_scan(folder.write("before.las", before.bytes()), {})->crs() == name);
  before.records = {record("other", 2112, name)};
  CHECK(open_scan(folder.write("other.las", before.bytes()), {})->crs().empty());

  std::string behind = LasFile{.minor = 4, .points = {point(20, 1, 2, 3)}}.bytes();
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
  las.points = {point(20, 1, 2, 3), point(20, -2147483648, 2147483647, 0)};
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
    std::string p = point(bytes, 1, 2, 3);
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
  std::string p = point(20 + 2 + 4 + 12 + 3 + 8 + 2, 1, 2, 3);
  put<std::int16_t>(p, 20, -300);
  put<float>(p, 22, 2.5f);
  for (std::size_t i = 0; i < 3; ++i) put<std::int32_t>(p, 26 + 4 * i, static_cast<std::int32_t>(i) + 7);
  for (std::size_t i = 0; i < 3; ++i) put<std::uint8_t>(p, 38 + i, static_cast<std::uint8_t>(i) + 1);
  put<std::uint64_t>(p, 41, 1ull << 40);
  put<std::uint8_t>(p, 49, 5);
  put<std::uint8_t>(p, 50, 6);
  LasFile las{.points = {p}};
  las.records = {
      record("other", 4, "nothing"),
      record("LASF_Spec", 4,
             extra_descriptor("height above", 4, 8 + 16, 0.5, 100) + extra_descriptor("width", 9) +
                 extra_descriptor("normal", 26) + extra_descriptor("raw", 0, 3) + extra_descriptor("x", 7))};
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

LasFile small_file() {
  LasFile las{.minor = 4, .format = 7};
  for (int i = 0; i < 3; ++i) las.points.push_back(point(36 + 4, i, 2 * i, 3 * i));
  las.records = {record("LASF_Spec", 4, extra_descriptor("width", 9))};
  return las;
}

TEST_CASE("LAS cut at any byte is an error, with more behind the points it is read", "[io]") {
  const ScratchFolder folder;
  const std::string whole = small_file().bytes();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string error = read_error(folder.write("a.las", whole.substr(0, length)));
    INFO(length << ": " << error);
    CHECK(error != "");
    CHECK(error.find('\n') == std::string::npos);
  }
  CHECK(read_table(folder.write("a.las", whole + "extended records")).rows.size() == 3);
}

TEST_CASE("LAS with changed bytes gives rows or an error", "[io]") {
  const ScratchFolder folder;
  const std::string whole = small_file().bytes();
  std::mt19937 random(1);
  for (int round = 0; round < 4000; ++round) {
    std::string changed = whole;
    for (int i = 0; i < 1 + round % 3; ++i)
      changed[random() % changed.size()] = static_cast<char>(random() % 3 == 0 ? 0xff : random());
    const auto file = folder.write("a.las", changed);
    const std::string error = read_error(file);
    CHECK(error.find('\n') == std::string::npos);
    if (error.empty()) CHECK(read_table(file).rows.size() < 100);
  }
}

TEST_CASE("what is wrong with a LAS file is said with its place", "[io]") {
  const ScratchFolder folder;
  const std::string whole = small_file().bytes();
  const auto error = [&](std::size_t offset, auto value) {
    std::string changed = whole;
    put(changed, offset, value);
    return read_error(folder.write("a.las", changed));
  };
  CHECK_THAT(error(25, std::uint8_t{5}), Contains("byte 24: LAS 1.5; versions 1.0 to 1.4 are read"));
  CHECK_THAT(error(104, std::uint8_t{11}), Contains("byte 104: point format 11; formats 0 to 10 are read"));
  CHECK_THAT(error(105, std::uint16_t{35}),
             Contains("points of 35 bytes; those of format 7 have 36 or more"));
  CHECK_THAT(error(247, std::uint64_t{1} << 60),
             Contains("the header declares 1152921504606846976 points") && Contains("but only 3 follow"));
  CHECK_THAT(error(131, 0.0), Contains("byte 131: a scale that is 0"));
  CHECK_THAT(error(96, std::uint32_t{100}), Contains("the points begin within the header"));
  CHECK_THAT(error(100, std::uint32_t{7}), Contains("7 variable length records do not fit"));
}

}  // namespace
}  // namespace lacuna::test
