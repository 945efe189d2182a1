// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/crs.hpp"
#include "io/read/formats.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/rows/readers.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

using Key = std::array<std::uint16_t, 4>;  // key, place, count, value

void take(LasCrs& crs, std::uint16_t record, const std::string& data) {
  crs.take(record, std::as_bytes(std::span(data)));
}

LasCrs crs_of(const std::vector<Key>& keys, const std::string& text = "") {
  LasCrs crs;
  take(crs, 34735, las_geo_keys(keys));
  if (!text.empty()) take(crs, 2112, text);
  return crs;
}

constexpr bool kDegrees = true, kLengths = false;

}  // namespace

TEST_CASE("GeoTIFF keys give codes of EPSG, and say whether positions are longitude and latitude") {
  struct Case {
    std::vector<Key> keys;
    std::string system;
    bool are_degrees;
  };
  const Case cases[] = {
      {{}, "", kLengths},
      {{{2048, 0, 1, 4258}}, "EPSG:4258", kDegrees},  // without a model
      {{{2048, 0, 1, 4258}, {3072, 0, 1, 25832}}, "EPSG:25832", kLengths},
      {{{1024, 0, 1, 1}, {3072, 0, 1, 25832}, {4096, 0, 1, 7837}}, "EPSG:25832+7837", kLengths},
      {{{3072, 34736, 1, 5}}, "", kLengths},  // its value is elsewhere
      {{{4096, 0, 1, 7837}}, "", kLengths},
      // A vertical code that is no system of EPSG leaves the horizontal system.
      {{{1024, 0, 1, 1}, {3072, 0, 1, 26913}, {4096, 0, 1, 5103}}, "EPSG:26913", kLengths},
      // A projected system without a code is not the geographic one that it rests on.
      {{{1024, 0, 1, 1}, {2048, 0, 1, 4258}, {3072, 0, 1, 32767}}, "", kLengths},
      {{{1024, 0, 1, 1}, {2048, 0, 1, 4258}}, "", kLengths},
      {{{1024, 0, 1, 2}, {2048, 0, 1, 4258}, {3072, 0, 1, 32767}}, "EPSG:4258", kDegrees},
      {{{1024, 0, 1, 2}, {2048, 0, 1, 32767}}, "", kDegrees},
      // A geocentric system is not the geographic one that names its datum.
      {{{1024, 0, 1, 3}, {2048, 0, 1, 4326}}, "EPSG:4978", kLengths}};
  for (const auto& [keys, system, are_degrees] : cases) {
    INFO(system);
    CHECK(crs_of(keys).text() == system);
    CHECK(crs_of(keys).is_geographic() == are_degrees);
    CHECK(crs_of(keys, known_system("GEOGCS")).is_geographic());
    CHECK_FALSE(crs_of(keys, known_system("a")).is_geographic());
  }
}

TEST_CASE("keys and well-known text state the units, and the one that contradicts is the other unit") {
  CHECK(crs_of({{1024, 0, 1, 3}, {2048, 0, 1, 4326}}).length_unit() == "m");  // geocentric
  const LasCrs keys = crs_of({{3072, 0, 1, 26913}, {3076, 0, 1, 9001}, {4099, 0, 1, 9003}});
  CHECK(keys.length_unit() == "m");
  CHECK(keys.vertical_unit() == "us-ft");
  CHECK(keys.other_unit().empty());
  const LasCrs text = crs_of({}, "COMPD_CS[\"a\"," + known_system("b") +
                                     ",VERT_CS[\"c\",VERT_DATUM[\"d\",2005],UNIT[\"foot\",0.3048]]]");
  CHECK(text.length_unit() == "m");
  CHECK(text.vertical_unit() == "ft");
  const LasCrs both = crs_of({{3072, 0, 1, 25832}, {3076, 0, 1, 9003}}, known_system("b"));
  CHECK(both.length_unit() == "m");
  CHECK(both.other_unit() == "us-ft");
}

TEST_CASE("the size of a unit without a code is among the doubles of the keys, in any order") {
  const double sizes[] = {6378137, 1200. / 3937};
  const std::string doubles(reinterpret_cast<const char*>(sizes), sizeof sizes);
  const std::string keys = las_geo_keys({{3072, 0, 1, 32767}, {3076, 0, 1, 32767}, {3077, 34736, 1, 1}});
  LasCrs first, last;
  take(first, 34736, doubles);
  take(first, 34735, keys);
  take(last, 34735, keys);
  CHECK(last.length_unit().empty());
  take(last, 34736, doubles.substr(0, 12));  // cut
  CHECK(last.length_unit().empty());
  take(last, 34736, doubles);
  CHECK(first.length_unit() == "us-ft");
  CHECK(last.length_unit() == "us-ft");
}

TEST_CASE("well-known text counts over keys, up to its first zero") {
  LasCrs crs;
  take(crs, 2112, std::string("PROJCS[\"A\"]\0\0", 13));
  take(crs, 34735, las_geo_keys({{3072, 0, 1, 25832}}));
  CHECK(crs.text() == "PROJCS[\"A\"]");
}

TEST_CASE("the header's bit decides between keys and well-known text of two systems") {
  const auto chosen = [](std::uint16_t code, const std::string& text, bool has_text_bit) {
    LasCrs crs = crs_of({{3072, 0, 1, code}, {3076, 0, 1, 9003}}, text);
    crs.choose(has_text_bit);
    return crs;
  };
  for (const std::string& text :
       {known_system("b", "metre\",1", 25833), io::facts_of("EPSG:25833").known_text}) {
    const LasCrs keys = chosen(25832, text, false), of_text = chosen(25832, text, true);
    CHECK(keys.text() == "EPSG:25832");
    CHECK(keys.other_text() == text);
    CHECK(keys.length_unit() == "us-ft");
    CHECK(keys.other_unit() == "m");
    CHECK(of_text.text() == text);
    CHECK(of_text.other_text() == "EPSG:25832");
    CHECK(of_text.length_unit() == "m");
    for (const bool has_text_bit : {false, true}) {
      const LasCrs same = chosen(25833, text, has_text_bit);  // the text says more than the code
      CHECK(same.text() == text);
      CHECK(same.other_text().empty());
    }
  }
  CHECK(chosen(25832, "", true).text() == "EPSG:25832");
  CHECK(chosen(32767, "PROJCS[\"b\"]", false).text() == "PROJCS[\"b\"]");  // keys without a code
}

TEST_CASE("keys that are cut are passed over") {
  const std::string keys = las_geo_keys({{3072, 0, 1, 25832}, {4096, 0, 1, 7837}});
  for (std::size_t length = 0; length < keys.size(); ++length) {
    LasCrs crs;
    take(crs, 34735, keys.substr(0, length));
    CHECK(crs.text() == (length < 16 ? "" : "EPSG:25832"));
  }
}

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

  std::string behind = with_extended(
      LasFile{.minor = 4, .points = {las_point(20, 1, 2, 3)}}.bytes(),
      {las_extended_record("other", 2112, name), las_extended_record("LASF_Projection", 2112, name)});
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
  using Values = std::map<std::string, double>;
  const ScratchFolder folder;
  for (int format = 0; format <= 10; ++format) {
    INFO("format " << format);
    const bool is_new = format >= 6, has_time = format != 0 && format != 2,
               has_colour =
                   format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10,
               has_wave = format == 4 || format == 5 || format >= 9;
    std::string p = las_point(12, 1, 2, 3);
    Values expected;
    const auto add = [&](auto stored, const Values& values) {
      put(p, p.size(), stored);
      expected.insert(values.begin(), values.end());
    };
    add(std::uint16_t{65'535}, {{"intensity", 65'535}});
    if (is_new) {
      add(std::uint8_t{0b1100'1011}, {{"return_number", 11}, {"number_of_returns", 12}});
      add(std::uint8_t{0b1'0'10'1'0'1'1}, {{"edge_of_flight_line", 1},
                                           {"scan_direction_flag", 0},
                                           {"scanner_channel", 2},
                                           {"overlap", 1},
                                           {"withheld", 0},
                                           {"key_point", 1},
                                           {"synthetic", 1}});
      add(std::uint8_t{64}, {{"classification", 64}});
      add(std::uint8_t{200}, {{"user_data", 200}});
      add(std::int16_t{-15'000}, {{"scan_angle", -90}});
    } else {
      add(std::uint8_t{0b1'0'011'010}, {{"edge_of_flight_line", 1},
                                        {"scan_direction_flag", 0},
                                        {"number_of_returns", 3},
                                        {"return_number", 2}});
      add(std::uint8_t{0b1'0'1'00110},
          {{"withheld", 1}, {"key_point", 0}, {"synthetic", 1}, {"classification", 6}});
      add(std::int8_t{-90}, {{"scan_angle", -90}});
      add(std::uint8_t{200}, {{"user_data", 200}});
    }
    add(std::uint16_t{4000}, {{"point_source_id", 4000}});
    if (has_time) add(123456.789, {{"gps_time", 123456.789}});
    for (const auto& [name, number] : {std::pair{"red", 1000}, {"green", 2000}, {"blue", 3000}})
      if (has_colour) add(static_cast<std::uint16_t>(number), {{name, number}});
    if (format == 8 || format == 10) add(std::uint16_t{777}, {{"nir", 777}});
    if (has_wave) {
      add(std::uint8_t{9}, {});
      add(std::uint64_t{1'000'000'000'000}, {{"wave_packet_offset", 1e12}});
      add(std::uint32_t{256}, {{"wave_packet_bytes", 256}});
      add(1.5f, {{"wave_return_location", 1.5}});
      for (const auto& [name, number] : {std::pair{"wave_x", 0.25f}, {"wave_y", 0.5f}, {"wave_z", 0.75f}})
        add(number, {{name, number}});
    }
    REQUIRE(p.size() == las_point_bytes(format));

    const LasFile las{.minor = is_new ? 4 : 3, .format = format, .points = {p, p}, .records = {}};
    const Table table = read_table(folder.write("a.las", las.bytes()));
    REQUIRE(table.rows.size() == 2);
    for (const auto& [name, number] : expected) {
      INFO(name);
      CHECK(value(table, 1, name) == number);
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

TEST_CASE("stored values of extra bytes that mean no data are NaN, whatever their scale", "[io]") {
  const ScratchFolder folder;
  std::string height = las_extra_descriptor("height", 4, 1 + 8, 0.01, 0),
              width = las_extra_descriptor("width", 9, 1), count = las_extra_descriptor("count", 1, 1);
  put(height, 40, std::int64_t{-9999});
  put(width, 40, -0.1);
  put(count, 40, std::uint64_t{255});
  std::vector<std::string> points(2, las_point(20 + 2 + 4 + 1, 1, 2, 3));
  put<std::int16_t>(points[0], 20, -9999);
  put<float>(points[0], 22, -0.1f);
  put<std::uint8_t>(points[0], 26, 255);
  put<std::int16_t>(points[1], 20, 150);
  LasFile las{.points = points};
  las.records = {las_record("LASF_Spec", 4, height + width + count)};
  const Table table = read_table(folder.write("a.las", las.bytes()));
  for (const char* name : {"height", "width", "count"}) CHECK(std::isnan(value(table, 0, name)));
  CHECK(value(table, 1, "height") == 1.5);
  CHECK(value(table, 1, "width") == 0);
  CHECK(value(table, 1, "count") == 0);
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
  check_refused("a.las",
                {{with(25, std::uint8_t{6}), "byte 24: LAS 1.6; versions 1.0 to 1.5 are read"},
                 {with(104, std::uint8_t{11}), "byte 104: point format 11; formats 0 to 10"},
                 {with(105, std::uint16_t{35}), "points of 35 bytes; those of format 7 have 36"},
                 {with(247, std::uint64_t{1} << 60), "the header counts 1152921504606846976 points, but 3"},
                 {with(131, 0.0), "byte 131: a scale that is 0"},
                 {with(96, std::uint32_t{100}), "the points begin within the header"},
                 {with(100, std::uint32_t{7}), "7 variable length records do not fit"}});
}

}  // namespace
}  // namespace lacuna::test
