// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/e57.hpp"
#include "io/read/files/number.hpp"
#include "io/read/formats.hpp"
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
namespace {

using Random = std::mt19937_64;

constexpr std::size_t kPage = 1024;

// n coordinates, all different.
std::vector<float> drawn(Random& random, std::size_t n) {
  std::uniform_real_distribution<float> number(-100, 100);
  std::vector<float> values(n);
  for (float& value : values) value = number(random);
  return values;
}

std::vector<E57Values> position(const std::vector<float>& x, const std::vector<float>& y,
                                const std::vector<float>& z) {
  return {e57_floats("cartesianX", x), e57_floats("cartesianY", y), e57_floats("cartesianZ", z)};
}

// One point, with more fields.
E57TestScan one_point(std::vector<E57Values> more = {}) {
  E57TestScan scan{.fields = position({1}, {2}, {3})};
  for (E57Values& field : more) scan.fields.push_back(std::move(field));
  return scan;
}

struct E57Folder {
  ScratchFolder folder;

  // Writes a new file each time: some file systems write a file that is cut to nothing to the disk at once.
  std::string write(const std::string& bytes) const {
    fs::remove(folder / "a.e57");
    return folder.write("a.e57", bytes);
  }
  Table read(const std::vector<E57TestScan>& scans, const E57FileForm& form = {},
             std::size_t max_rows = 1000) const {
    return read_table(write(encode_e57(scans, form)), max_rows);
  }
  std::string error(const std::vector<E57TestScan>& scans, const E57FileForm& form = {}) const {
    return read_error(write(encode_e57(scans, form)));
  }
  std::vector<Scalar> types(const std::vector<E57TestScan>& scans) const {
    const auto reader = open_scan(write(encode_e57(scans)), {});
    std::vector<Scalar> types;
    for (const Property& property : reader->layout().properties) types.push_back(property.type);
    return types;
  }
};

using Row = std::vector<double>;

TEST_CASE("points of E57 are read, with scans in order, and the reader says what it reads", "[e57]") {
  const E57Folder folder;
  const std::vector<E57TestScan> scans = {{.fields = position({1, 4}, {2, 5}, {3, 6})},
                                          {.fields = position({7}, {8}, {9})}};
  const Table table = folder.read(scans);
  CHECK(table.names == Names{"x", "y", "z", "scan"});
  CHECK(table.rows == std::vector<Row>{{1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 9, 1}});
  CHECK(folder.types(scans) ==
        std::vector{Scalar::kFloat64, Scalar::kFloat64, Scalar::kFloat64, Scalar::kUint32});
  const auto reader = open_scan(folder.write(encode_e57(scans)), {});
  CHECK(reader->format() == "E57 1.0, 2 scans");
  CHECK(reader->expected_rows() == std::uint64_t{3});
}

TEST_CASE("integers of E57 of every number of bits are read, wherever packets and pages cut them", "[e57]") {
  const E57Folder folder;
  Random random(1);
  constexpr std::size_t kPoints = 700;
  for (const std::size_t packets : {1, 2, 37}) {
    for (const unsigned bits : {0u, 1u, 2u, 7u, 8u, 13u, 16u, 31u, 32u, 33u, 57u, 63u, 64u}) {
      INFO(bits << " bits in " << packets << " packets");
      const std::uint64_t mask = bits == 0 ? 0 : ~std::uint64_t{0} >> (64 - bits);
      const std::int64_t minimum = bits == 64 ? std::numeric_limits<std::int64_t>::min() : -5;
      std::vector<std::int64_t> values(kPoints);
      for (auto& value : values)
        value = static_cast<std::int64_t>((random() & mask) + static_cast<std::uint64_t>(minimum));
      const auto maximum = static_cast<std::int64_t>(mask + static_cast<std::uint64_t>(minimum));
      const auto x = drawn(random, kPoints), y = drawn(random, kPoints), z = drawn(random, kPoints);
      E57TestScan scan{.fields = position(x, y, z), .packets = packets};
      scan.fields.insert(scan.fields.begin() + 1, e57_integers("whole", minimum, maximum, values));
      scan.fields.push_back(e57_scaled("scaled", minimum, maximum, 0.001, -7, values));
      scan.fields.push_back(e57_doubles("double", {x.begin(), x.end()}));
      const Table table = folder.read({scan}, {}, 97);
      REQUIRE(table.rows.size() == kPoints);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < kPoints; ++i) {
        const auto value = static_cast<double>(values[i]);
        wrong += table.rows[i] != Row{x[i], y[i], z[i], value, value * 0.001 - 7, x[i], 0};
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("attributes of E57 become columns of the smallest type that holds them", "[e57]") {
  const E57Folder folder;
  const E57TestScan scan =
      one_point({e57_integers("colorRed", 0, 255, {200}), e57_integers("colorGreen", 0, 1023, {1000}),
                 e57_integers("colorBlue", 0, 255, {7}), e57_floats("intensity", {0.5f}),
                 e57_integers("rowIndex", 0, 70000, {69999}), e57_integers("columnIndex", -3, 100, {-2}),
                 e57_integers("returnIndex", 0, 255, {255}), e57_integers("returnCount", 0, 7, {3}),
                 e57_doubles("timeStamp", {0.1}), e57_integers("isColorInvalid", 0, 1, {1}),
                 e57_scaled("ext:someValue", 0, 9, 0.5, 1, {4}),
                 e57_integers("ext:big", 0, std::int64_t{1} << 40, {std::int64_t{1} << 39})});
  const Table table = folder.read({scan});
  CHECK(table.names == Names{"x", "y", "z", "red", "green", "blue", "intensity", "row_index", "column_index",
                             "return_number", "number_of_returns", "time_stamp", "is_color_invalid",
                             "ext_some_value", "ext_big", "scan"});
  CHECK(table.rows ==
        std::vector<Row>{{1, 2, 3, 200, 1000, 7, 0.5, 69999, -2, 256, 3, 0.1, 1, 3, 0x1p39, 0}});
  const std::vector<Scalar> types = folder.types({scan});
  CHECK(std::vector(types.begin() + 3, types.end()) ==
        std::vector{Scalar::kUint8, Scalar::kUint16, Scalar::kUint8, Scalar::kFloat32, Scalar::kUint32,
                    Scalar::kInt8, Scalar::kUint16, Scalar::kUint8, Scalar::kFloat64, Scalar::kUint8,
                    Scalar::kFloat64, Scalar::kFloat64, Scalar::kUint32});
}

TEST_CASE("a pose of E57 turns and moves points, and turns normals", "[e57]") {
  const E57Folder folder;
  Random random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Quaterniond turn(number(random), number(random), number(random), number(random));
    const Eigen::Vector3d place(10, 20, 30), normal(1, 0, 0.25);
    E57TestScan scan = one_point(
        {e57_floats("nor:normalX", {1}), e57_floats("nor:normalY", {0}), e57_doubles("nor:normalZ", {0.25})});
    scan.pose = e57_pose({turn.w(), turn.x(), turn.y(), turn.z()}, {10, 20, 30});
    const Table table = folder.read({scan, one_point()});
    CHECK(table.names == Names{"x", "y", "z", "nx", "ny", "nz", "scan"});
    REQUIRE(table.rows.size() == 2);
    const Eigen::Quaterniond unit = turn.normalized();
    const Eigen::Vector3d moved = unit * Eigen::Vector3d(1, 2, 3) + place, turned = unit * normal;
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(table.rows[0][i] == Approx(moved[Eigen::Index(i)]).margin(1e-12));
      CHECK(table.rows[0][3 + i] == Approx(turned[Eigen::Index(i)]).margin(1e-7));
    }
    CHECK(Row(table.rows[1].begin(), table.rows[1].begin() + 3) == Row{1, 2, 3});
    CHECK(std::isnan(table.rows[1][3]));
  }
}

TEST_CASE("a rotation of E57 by the quaternion 0 0 0 0, or nearly so, is none, and noted", "[e57]") {
  const E57Folder folder;
  for (const double w : {0.0, 1e-9, -1e-300}) {
    E57TestScan zero = one_point();
    zero.pose = e57_pose({w, 0, 0, 0}, {10, 20, 30});
    E57TestScan half = one_point();
    half.pose = e57_pose({0, 0, 0, 0.01}, {0, 0, 0});  // half a turn about z
    const Table table = folder.read({zero, one_point(), zero, half});
    REQUIRE(table.rows.size() == 4);
    CHECK(Row(table.rows[0].begin(), table.rows[0].begin() + 3) == Row{11, 22, 33});
    CHECK(table.rows[3][0] == Approx(-1));
    const auto notes = open_scan(folder.folder / "a.e57", {})->notes();
    REQUIRE(!notes.empty());
    CHECK(notes[0].count == 2);
    CHECK(notes[0].what.find("no rotation") != std::string::npos);
  }
}

TEST_CASE("E57 whose packets hold more points than its recordCount is an error, unless it is trusted",
          "[e57]") {
  const E57Folder folder;
  Random random(5);
  constexpr std::size_t kPoints = 700;
  const auto floats = position(drawn(random, kPoints), drawn(random, kPoints), drawn(random, kPoints));
  std::vector<std::int64_t> numbers(kPoints);
  for (std::int64_t& number : numbers) number = static_cast<std::int64_t>(random() % 100'000);
  std::vector<E57Values> integers;
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
    integers.push_back(e57_scaled(name, 0, 100'000, 0.001, 0, numbers));
  for (const bool is_float : {true, false}) {
    for (const std::size_t packets : {std::size_t{1}, std::size_t{4}}) {
      E57TestScan scan{.fields = is_float ? floats : integers, .packets = packets};
      CHECK(folder.read({scan, scan}).rows.size() == 2 * kPoints);
      // Two points of 17 bits are no padding of a word of 32 bits; one may be.
      for (const std::size_t fewer : {std::size_t{1}, std::size_t{2}, kPoints / 2, kPoints - 1, kPoints}) {
        if (!is_float && fewer == 1) continue;   // may be padding
        scan.fields[0].count = kPoints - fewer;  // the encoder states it
        INFO(is_float << " " << packets << " " << fewer);
        CHECK_THAT(folder.error({scan, one_point()}),
                   Contains("scan 0: its packets hold more than the " + std::to_string(kPoints - fewer) +
                            " points of its recordCount; --trust header"));
        const ReadOptions trusting{.columns = "", .trust = Trust::kHeader};
        CHECK(read_table(folder.folder / "a.e57", 1000, trusting).rows.size() == kPoints - fewer + 1);
      }
    }
  }
}

TEST_CASE("spherical points of E57 are where the same Cartesian ones are", "[e57]") {
  const E57Folder folder;
  Random random(2);
  std::uniform_real_distribution<double> range(0.1, 100), azimuth(-7, 7),
      elevation(-std::numbers::pi / 2, std::numbers::pi / 2);
  std::vector<double> r, a, e, x, y, z;
  for (int i = 0; i < 1000; ++i) {
    r.push_back(range(random));
    a.push_back(i < 9 ? (i - 4) * std::numbers::pi / 2 : azimuth(random) * (i % 10 == 0 ? 1e5 : 1));
    e.push_back(elevation(random));
    x.push_back(r.back() * std::cos(e.back()) * std::cos(a.back()));
    y.push_back(r.back() * std::cos(e.back()) * std::sin(a.back()));
    z.push_back(r.back() * std::sin(e.back()));
  }
  const std::vector<E57Values> spherical = {e57_doubles("sphericalRange", r),
                                            e57_doubles("sphericalAzimuth", a),
                                            e57_doubles("sphericalElevation", e)};
  const std::vector<E57Values> cartesian = e57_position(x, y, z);
  const Table one = folder.read({{.fields = spherical}}), other = folder.read({{.fields = cartesian}});
  CHECK(one.names == Names{"x", "y", "z", "scan"});
  double farthest = 0;
  for (const char* axis : {"x", "y", "z"}) {
    const Row p = one.column(axis), q = other.column(axis);
    for (std::size_t i = 0; i < p.size(); ++i) farthest = std::max(farthest, std::abs(p[i] - q[i]) / r[i]);
  }
  CHECK(farthest < 1.5e-15);
  // Where both are given, Cartesian coordinates count.
  E57TestScan both{.fields = spherical};
  both.fields.insert(both.fields.end(), cartesian.begin(), cartesian.end());
  const Table table = folder.read({both});
  CHECK(table.names ==
        Names{"x", "y", "z", "spherical_range", "spherical_azimuth", "spherical_elevation", "scan"});
  CHECK(table.column("x") == x);
  CHECK(table.column("spherical_range") == r);
}

TEST_CASE("rays of E57 without a return have no position, and keep their row", "[e57]") {
  const E57Folder folder;
  E57TestScan scan{.fields = position({1, 2, 3, 0, 0}, {1, 2, 3, -0.0f, 0}, {1, 2, 3, 0, 4})};
  scan.pose = e57_pose({1, 0, 0, 0}, {10, 0, 0});
  scan.fields.push_back(e57_integers("cartesianInvalidState", 0, 2, {0, 1, 2, 0, 0}));
  const Table table = folder.read({scan});
  CHECK(table.column("cartesian_invalid_state") == Row{0, 1, 2, 0, 0});
  const Row x = table.column("x");
  CHECK(x[0] == 11);
  for (const std::size_t i : {1, 2, 3}) CHECK(std::isnan(x[i]));
  CHECK(x[4] == 10);

  const E57TestScan spherical{.fields = {e57_floats("sphericalRange", {0, 5, 5}),
                                         e57_floats("sphericalAzimuth", {1, 0, 0}),
                                         e57_floats("sphericalElevation", {0, 0, 0}),
                                         e57_integers("sphericalInvalidState", 0, 2, {0, 1, 0})}};
  const Row range = folder.read({spherical}).column("x");
  CHECK(std::isnan(range[0]));
  CHECK(std::isnan(range[1]));
  CHECK(range[2] == 5);
}

TEST_CASE("E57: angles beyond a full turn are counted, but for invalid rays", "[e57]") {
  const E57Folder folder;
  const auto rays = [](double azimuth, double elevation, std::int64_t state) {
    return E57TestScan{.fields = {e57_doubles("sphericalRange", {5, 5}),
                                  e57_doubles("sphericalAzimuth", {azimuth, 0}),
                                  e57_doubles("sphericalElevation", {elevation, 0}),
                                  e57_integers("sphericalInvalidState", 0, 2, {state, 0})}};
  };
  const auto wide_angles = [&](const E57TestScan& scan) {
    return findings_of(folder.write(encode_e57({scan}))).wide_angles;
  };
  CHECK(wide_angles(rays(6.283, 1.5, 0)) == 0);
  CHECK(wide_angles(rays(90, 0, 0)) == 1);
  CHECK(wide_angles(rays(0, -45, 0)) == 1);
  CHECK(wide_angles(rays(90, 0, 2)) == 0);
}

TEST_CASE("scans of E57 with different fields share the columns of all", "[e57]") {
  const E57Folder folder;
  const std::vector<E57TestScan> scans = {
      one_point({e57_floats("intensity", {0.5f}), e57_integers("rowIndex", 0, 9, {4})}),
      {},
      one_point({e57_integers("colorRed", 0, 255, {9}), e57_integers("intensity", 0, 99, {42})})};
  const Table table = folder.read(scans);
  CHECK(table.names == Names{"x", "y", "z", "intensity", "row_index", "red", "scan"});
  CHECK(table.rows == std::vector<Row>{{1, 2, 3, 0.5, 4, 0, 0}, {1, 2, 3, 42, 0, 9, 2}});
  CHECK(folder.types(scans)[3] == Scalar::kFloat64);
}

TEST_CASE("E57 is read in pages of any size", "[e57]") {
  const E57Folder folder;
  Random random(5);
  const auto x = drawn(random, 500), y = drawn(random, 500), z = drawn(random, 500);
  for (const std::size_t page_bytes : {64, 128, 4096, 1 << 20}) {
    const Table table =
        folder.read({{.fields = position(x, y, z), .packets = 5}}, {.page_bytes = page_bytes});
    CHECK(table.column("y") == Row(y.begin(), y.end()));
  }
}

TEST_CASE("a wrong checksum of E57 is said with its page, wherever the page is", "[e57]") {
  const E57Folder folder;
  Random random(6);
  const auto x = drawn(random, 500);
  const std::string whole = encode_e57({{.fields = position(x, x, x), .packets = 3}});
  for (std::size_t page = 0; page < whole.size() / kPage; ++page) {
    for (const std::size_t byte : {100, 1019, 1020, 1023}) {
      std::string damaged = whole;
      damaged[page * kPage + byte] ^= 4;
      CHECK_THAT(read_error(folder.write(damaged)),
                 Contains("byte " + std::to_string(page * kPage) + ": the checksum of the page"));
    }
  }
}

TEST_CASE("what is wrong in E57 is said with its place", "[e57]") {
  const auto patched = [whole = encode_e57({one_point()})](std::size_t at, auto value) {
    std::string file = whole;
    std::memcpy(file.data() + at, &value, sizeof value);
    repair_e57_checksums(file);
    return file;
  };
  constexpr std::uint64_t kMost = ~std::uint64_t{0};
  const std::size_t packet = 48 + 32 + 16;
  check_refused("a.e57",
                {{patched(8, std::uint32_t{2}), "byte 8: E57 2.0; version 1.0 is read"},
                 {patched(40, std::uint64_t{1000}), "byte 40: pages of 1000 bytes"},
                 {patched(16, std::uint64_t{1}), "byte 16: the header states 1 bytes"},
                 {patched(24, kMost), "the XML section should begin"},
                 {patched(24, std::uint64_t{1021}), "byte 1021: the XML section should begin here, within"},
                 {patched(32, kMost), "byte 32: an XML section of 18446744073709551615 bytes"},
                 {patched(48, std::uint8_t{2}), "byte 48: scan 0: its points begin with 2"},
                 {patched(56, std::uint64_t{1} << 60), "byte 48: scan 0: the section of its points has"},
                 {patched(64, std::uint64_t{0}), "its first packet is not in the section"},
                 {patched(packet, std::uint8_t{9}), "byte 96: scan 0: a packet of type 9"},
                 {patched(packet + 2, std::uint16_t{999}), "byte 96: scan 0: a packet of 1000 bytes"},
                 {patched(packet + 4, std::uint16_t{2}), "a packet of 2 fields; its points have 3"},
                 {patched(packet + 6, std::uint16_t{999}), "longer than its 24 bytes"},
                 {patched(packet + 10, std::uint16_t{5}), "longer than its 24 bytes"},
                 {patched(packet, std::uint8_t{2}), "its packets end here, 1 points too early"}});
}

TEST_CASE("what E57 may hold but is not read is named", "[e57]") {
  const E57Folder folder;
  std::vector<Wrong> cases;
  const auto add = [&](const E57TestScan& scan, const std::string& part) {
    cases.push_back({encode_e57({scan}), part});
  };
  const auto with = [](const std::string& name, const std::string& attributes) {
    return one_point({{.name = name, .attributes = attributes}});
  };
  add(with("comment", "type=\"String\""), "field 'comment' of the points has the type 'String'");
  add(with("a", "type=\"Integer\" minimum=\"3\" maximum=\"2\""), "a maximum below its minimum");
  add(with("a", "type=\"Integer\" minimum=\"x\""), "the minimum of 'a' is 'x'; it must be a whole");
  add(with("a", "type=\"ScaledInteger\" scale=\"0\""), "a scale that is 0");
  add(with("a", "type=\"Float\" precision=\"half\""), "the precision 'half'");
  add(with("scan", "type=\"Integer\" maximum=\"0\" minimum=\"0\""), "become the column 'scan'");
  add({.fields = {e57_floats("cartesianX", {1}), e57_floats("cartesianY", {1})}},
      "scan 0: its points have no position");
  E57TestScan scan = one_point();
  scan.pose = e57_pose({1e200, 0, 0, 1e200}, {0, 0, 0});
  add(scan, "a quaternion must have the length 1");
  scan.pose.clear();
  scan.codecs =
      "<codecs type=\"Vector\"><vectorChild type=\"Structure\"><inputs type=\"Vector\"/>"
      "<zipCodec type=\"Structure\"/></vectorChild></codecs>";
  add(scan, "packed by 'zipCodec'");
  scan.fields[0].count = 1000000;
  scan.codecs.clear();
  add(scan, "1000000 points of 96 bits; the file holds at most");
  cases.push_back({encode_e57({}, {.root = "<data3D><vectorChild>"}), "the XML section cannot be read"});
  check_refused("a.e57", cases);

  scan = one_point();
  scan.codecs =
      "<codecs type=\"Vector\"><vectorChild type=\"Structure\"><inputs type=\"Vector\"/>"
      "<bitPackCodec type=\"Structure\"/></vectorChild></codecs>";
  CHECK(folder.error({scan}).empty());
  scan.pose = e57_pose({1, 0, 0, 0}, {0, NAN, 0});
  const std::string error = folder.error({scan});
  CHECK_THAT(error, Contains("'y' of a pose must be a Float with a finite number"));
  const std::size_t byte = std::stoul(error.substr(error.find("byte ") + 5));
  CHECK(read_file(folder.folder / "a.e57").substr(byte, 20) == "y type=\"Float\">nan</");
}

TEST_CASE("an XML section of E57 with entities or elements without end is an error or is passed over",
          "[e57]") {
  const E57Folder folder;
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  CHECK_THAT(folder.error({one_point()}, {.root = deep}), Contains("the XML section cannot be read"));
  for (int i = 0; i < 200000; ++i) deep += "</a>";
  CHECK(folder.error({one_point()}, {.root = deep}).empty());
  CHECK(folder.read({one_point()}, {.root = "<x>&lol9;&#0;</x>"}).rows.size() == 1);
}

TEST_CASE("the coordinate system of E57 is kept as it is written", "[e57]") {
  const E57Folder folder;
  const auto metadata = [&](const std::string& root) {
    return read_e57_header(folder.write(encode_e57({one_point()}, {.root = root}))).coordinate_metadata;
  };
  CHECK(metadata("").empty());
  CHECK(metadata("<coordinateMetadata type=\"String\"><![CDATA[PROJCS[\"a\",]]]]><![CDATA[>]]>&lt;"
                 "</coordinateMetadata>") == "PROJCS[\"a\",]]><");
}

TEST_CASE("points of E57 that take no bytes are refused beyond 64 values in a byte, and the file's bytes",
          "[e57]") {
  const E57Folder folder;
  const auto same = [](const std::string& name) { return e57_integers(name, 7, 7, {}); };
  E57TestScan scan{
      .fields = {same("cartesianX"), e57_scaled("cartesianY", 7, 7, 0.5, 0, {}), same("cartesianZ")}};
  scan.fields[0].count = 1'000;
  const Table table = folder.read({scan});
  REQUIRE(table.rows.size() == 1'000);
  CHECK(table.rows.back() == Row{7, 3.5, 7, 0});
  scan.fields[0].count = 10'000;
  CHECK_THAT(folder.error({scan}), Contains("10000 points of 0 bits; the file holds at most"));
  scan.fields[0].count = 90'000;
  CHECK_THAT(folder.error(std::vector<E57TestScan>(200, scan)), Contains("at most 64 in a byte are read"));
  scan.fields[0].count = 10'000;
  for (int i = 0; i < 200; ++i) scan.fields.push_back(same("same" + std::to_string(i)));
  CHECK_THAT(folder.error({scan}), Contains("the scans up to here have 2030000 values, in a file of "));
}

TEST_CASE("bytes of E57 held for other fields are few, and fields without bits need none", "[e57]") {
  const E57Folder folder;
  const std::vector<std::int64_t> flags(2000, 1);
  const std::vector<float> x(2000, 1.5f);
  E57TestScan scan{.fields = position(x, x, x), .packets = 200};
  scan.fields.push_back(e57_integers("isColorInvalid", 0, 1, flags));
  scan.fields.back().bytes.resize(std::size_t{9} << 20);
  CHECK_THAT(folder.error({scan}), Contains("scan 0: values of the same point are too far apart"));
  scan.fields.back().attributes = "type=\"Integer\" minimum=\"1\" maximum=\"1\"";
  CHECK(folder.read({scan}).column("is_color_invalid") == Row(2000, 1.0));
}

// Two scans of a few packets, of all types.
std::string small_file() {
  Random random(8);
  std::vector<std::int64_t> whole(40);
  for (auto& value : whole) value = static_cast<std::int64_t>(random() % 8192);
  const auto x = drawn(random, 40);
  E57TestScan first{.fields = position(x, x, x), .pose = e57_pose({1, 0, 0, 0}, {1, 2, 3}), .packets = 3};
  first.fields.push_back(e57_integers("rowIndex", 0, 8191, whole));
  first.fields.push_back(e57_scaled("intensity", 0, 8191, 0.5, 0, whole));
  first.fields.push_back(e57_integers("cartesianInvalidState", 0, 2, std::vector<std::int64_t>(40, 1)));
  const E57TestScan second{.fields = {e57_floats("sphericalRange", x), e57_floats("sphericalAzimuth", x),
                                      e57_floats("sphericalElevation", x), e57_floats("nor:normalX", x),
                                      e57_floats("nor:normalY", x), e57_floats("nor:normalZ", x)},
                           .packets = 2};
  return encode_e57({first, second});
}

// Checksums and the stated length are mended first, so that what lies behind them is read.
void read_mended(const fs::path& file, std::size_t max_rows, std::uint64_t most_points,
                 const PointVisitor& visit) {
  std::string bytes = read_file(file);
  if (bytes.size() >= 24) store(reinterpret_cast<std::byte*>(&bytes[16]), std::uint64_t{bytes.size()});
  repair_e57_checksums(bytes);
  fs::remove(file);
  std::ofstream(file, std::ios::binary) << bytes;
  read_scan(file, max_rows, most_points, visit);
}

}  // namespace

std::vector<WholeFile> e57_files() {
  WholeFile stated{.name = "E57", .bytes = small_file(), .points_in_a_byte = 1};
  WholeFile mended = stated;
  mended.name = "E57 with checksums that hold";
  mended.read = read_mended;
  return {stated, mended};
}

}  // namespace lacuna::test
