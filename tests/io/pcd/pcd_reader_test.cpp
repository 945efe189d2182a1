// SPDX-License-Identifier: Apache-2.0
#include "io/read/formats.hpp"
#include "io/read/pcd/lzf.hpp"
#include "tests/io/broken_files.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {
namespace {

const std::string kFields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

// Greedy: the last place with the same three bytes.
std::string packed(const std::string& bytes) {
  std::string result, literal;
  const auto flush = [&] {
    if (literal.empty()) return;
    result += static_cast<char>(literal.size() - 1);
    result += literal;
    literal.clear();
  };
  std::map<std::string, std::size_t> last;
  for (std::size_t i = 0; i < bytes.size();) {
    const std::string three = bytes.substr(i, 3);
    const auto found = last.find(three);
    std::size_t length = 0;
    if (three.size() == 3 && found != last.end() && i - found->second <= 8192) {
      while (length < 264 && i + length < bytes.size() && bytes[found->second + length] == bytes[i + length])
        ++length;
    }
    if (length >= 3) {
      flush();
      const std::size_t distance = i - found->second - 1;
      const std::size_t code = std::min<std::size_t>(length - 2, 7);
      result += static_cast<char>(code << 5 | distance >> 8);
      if (code == 7) result += static_cast<char>(length - 9);
      result += static_cast<char>(distance & 255);
    } else {
      literal += bytes[i];
      if (literal.size() == 32) flush();
      length = 1;
    }
    for (std::size_t j = i; j < i + length; ++j) last[bytes.substr(j, 3)] = j;
    i += length;
  }
  flush();
  return result;
}

std::string block(const std::string& bytes) {
  const std::string small = packed(bytes);
  Bytes sizes;
  sizes << static_cast<std::uint32_t>(small.size()) << static_cast<std::uint32_t>(bytes.size());
  return sizes.str() + small;
}

// Two points with a field of every kind, padding among them.
const std::string kCrowded =
    "FIELDS _ x y z rgb label _ fpfh normal_x normal_y normal_z big index\n"
    "SIZE 1 4 4 8 4 1 2 2 4 4 4 8 8\nTYPE U F F F F I I U F F F I U\nCOUNT 3 1 1 1 1 1 2 3 1 1 1 1 1\n";

const Names kCrowdedNames = {"x",      "y",      "z",  "red", "green", "blue", "label", "fpfh_0",
                             "fpfh_1", "fpfh_2", "nx", "ny",  "nz",    "big",  "index"};
const Rows kCrowdedRows = {{1.5, -2, 1e300, 1, 2, 3, -128, 1, 2, 65535, 0, 0.5, 1, -5e18, 18e18},
                           {4, 5, 6, 255, 254, 253, 127, 3, 4, 5, 1, 0, 0, 7, 8}};

using U8 = std::uint8_t;
using I8 = std::int8_t;
using U16 = std::uint16_t;

std::string crowded_rows() {
  Bytes b;
  for (const auto& r : kCrowdedRows) {
    const auto whole = [&](std::size_t i) { return static_cast<std::int64_t>(r[i]); };
    const auto single = [&](std::size_t i) { return static_cast<float>(r[i]); };
    b << U8{9} << U8{9} << U8{9} << single(0) << single(1) << r[2];
    b << static_cast<U8>(whole(5)) << static_cast<U8>(whole(4)) << static_cast<U8>(whole(3)) << U8{77};
    b << static_cast<I8>(whole(6)) << U16{9} << U16{9};
    for (const std::size_t i : {7, 8, 9}) b << static_cast<U16>(whole(i));
    for (const std::size_t i : {10, 11, 12}) b << single(i);
    b << whole(13) << static_cast<std::uint64_t>(r[14]);
  }
  return b.str();
}

// Rows to columns, with the fields of kCrowded.
std::string crowded_columns(bool with_padding) {
  const std::string rows = crowded_rows();
  const std::size_t stride = rows.size() / 2;
  const std::pair<std::size_t, bool> fields[] = {{3, true},  {4, false}, {4, false}, {8, false}, {4, false},
                                                 {1, false}, {4, true},  {6, false}, {4, false}, {4, false},
                                                 {4, false}, {8, false}, {8, false}};
  std::string columns;
  std::size_t offset = 0;
  for (const auto& [bytes, is_padding] : fields) {
    if (with_padding || !is_padding)
      for (const std::size_t row : {0, 1}) columns += rows.substr(row * stride + offset, bytes);
    offset += bytes;
  }
  return columns;
}

float packed_colour(std::uint32_t colour) {
  return std::bit_cast<float>(colour);
}

std::string crowded_ascii() {
  std::ostringstream text;
  text.precision(9);
  text << pcd_header(kCrowded, 2, "ascii") << "0 0 0 1.5 -2 1e300 " << packed_colour(0x010203)
       << " -128 0 0 1 2 65535 0 0.5 1 -5000000000000000000 18000000000000000000\n"
       << "_ _ _ 4 5 6 " << packed_colour(0x7ffefd) << " 127 0 0 3 4 5 1 0 0 7 8\n";
  return text.str();
}

std::vector<std::string> crowded_files() {
  return {crowded_ascii(), pcd_header(kCrowded, 2, "binary") + crowded_rows(),
          pcd_header(kCrowded, 2, "binary_compressed") + block(crowded_columns(false)),
          pcd_header(kCrowded, 2, "binary_compressed") + block(crowded_columns(true))};
}

}  // namespace

TEST_CASE("PCD: every field is kept in every encoding, padding apart", "[io]") {
  const ScratchFolder folder;
  for (const std::string& content : crowded_files()) {
    const auto file = folder.write("a.xyz", content);
    const Table table = read_table(file, 1);
    CHECK(table.names == kCrowdedNames);
    Rows expected = kCrowdedRows;
    if (content == crowded_ascii()) expected[1][3] = 0x7f;  // 0xfffefd is a NaN, which text cannot hold
    CHECK(table.rows == expected);
    CHECK(open_scan(file, {})->expected_rows() == 2u);
  }
  CHECK(open_scan(folder.write("a", crowded_files()[0]), {})->format() == "PCD, ascii");
  CHECK(open_scan(folder.write("a", crowded_files()[1]), {})->format() == "PCD, binary");
  CHECK(open_scan(folder.write("a", crowded_files()[2]), {})->format() == "PCD, binary_compressed");
}

TEST_CASE("PCD: rgba has alpha, packed as an integer too, and single floats keep their type", "[io]") {
  const ScratchFolder folder;
  const std::string fields = "FIELDS x y z rgba\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n";
  const auto file =
      folder.write("a.pcd", pcd_header(fields, 2, "ascii") + "nan nan nan 4278321666\n1 2 3 4278321666\n");
  const Table table = read_table(file);
  CHECK(table.names == Names{"x", "y", "z", "red", "green", "blue", "alpha"});
  REQUIRE(table.rows.size() == 2);  // a point that is NaN is a row
  CHECK(std::isnan(table.rows[0][0]));
  CHECK(table.rows[1] == std::vector<double>{1, 2, 3, 2, 2, 2, 255});
  const auto reader = open_scan(file, {});
  CHECK(reader->layout().find("x")->type == Scalar::kFloat32);
  CHECK(reader->layout().find("alpha")->type == Scalar::kUint8);
}

TEST_CASE("PCD: headers of old versions are understood", "[io]") {
  const ScratchFolder folder;
  for (const std::string head :
       {"VERSION .5\nFIELDS x y z\nPOINTS 1\nDATA ascii\n",
        "# by hand\n\nVERSION .6\r\nCOLUMNS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 1\r\nDATA ascii\r\n",
        "# .PCD v.7\nFIELDS X Y z\nWIDTH 1\nHEIGHT 1\nDATA ascii\n",
        "VERSION .7\nFIELDS x noise y z\nSIZE 4 2 4 4\nTYPE F U F F\nCOUNT 1 0 1 1\n"
        "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n"}) {
    INFO(head);
    const Table table = read_table(folder.write("a.pcd", head + "1 2 3"));
    CHECK(table.names == Names{"x", "y", "z"});
    CHECK(table.rows == Rows{{1, 2, 3}});
  }
  for (const std::string data : {"ascii", "binary", "binary_compressed"})
    CHECK(read_table(folder.write("a.pcd", pcd_header(kFields, 0, data))).rows.empty());
}

TEST_CASE("PCD: a header that says something impossible is an error that names its line", "[io]") {
  const std::string xyz = "FIELDS x y z\n", end = "POINTS 0\nDATA ascii\n";
  check_refused("a.pcd", {{"VERSION 0.8\n", "line 1: version '0.8'"}});
  check_refused("a.pcd",
                {{"VERSION .7\n", "line 2: a second line 'VERSION'"},
                 {"POINTS\n", "line 2: fewer values"},
                 {"POINTS -1\n", "line 2: '-1' is not a whole number"},
                 {"SIZE 4 4 4\n", "line 2: SIZE before FIELDS"},
                 {"FIELDS\n", "line 2: no fields"},
                 {xyz + "SIZE 4 4\n", "line 3: 2 values for the 3 fields"},
                 {xyz + "TYPE F F D\n", "line 3: unknown type 'D'"},
                 {xyz + "SIZE 4 4 3\nPOINTS 1\nDATA ascii\n", "line 5: field 'z' has type F of 3 bytes"},
                 {xyz + "COUNT 1 1 0\n" + end, "line 5: no field 'z'"},
                 {"FIELDS x y z a\nCOUNT 1 1 1 4294967295\n" + end, "more than the 10,000 columns"},
                 {xyz + "COUNT 1 1 2\n" + end, "line 5: no field 'z'"},
                 {"FIELDS x y\n" + end, "line 4: no field 'z'"},
                 {"FIELDS x y z x\n" + end, "line 4: two fields have the name 'x'"},
                 {"FIELDS x y z nx normal_x\n" + end, "two fields have the name 'nx'"},
                 {xyz + "DATA ascii\n", "line 3: neither POINTS nor WIDTH"},
                 {xyz + "WIDTH 2\nHEIGHT 3\nPOINTS 7\nDATA ascii\n", "WIDTH 2 times HEIGHT 3 is not"},
                 {xyz + "WIDTH 4294967296\nHEIGHT 4294967296\nDATA ascii\n", "is not the number"},
                 {"POINTS 1\nDATA ascii\n", "line 3: no line FIELDS"},
                 {xyz + "POINTS 1\nDATA zip\n", "line 4: unknown encoding 'zip'"},
                 {"COLOUR blue\n", "line 2: unknown keyword 'COLOUR'"},
                 {xyz, "line 2: the file ends here, within its header"}},
                "VERSION .7\n");
}

TEST_CASE("PCD: counts and sizes that the file cannot hold are errors at once", "[io]") {
  std::vector<Wrong> cases;
  for (const std::string data : {"ascii", "binary", "binary_compressed"}) {
    for (const std::string points : {"1000000000000000000", "18446744073709551615", "40"})
      cases.push_back(
          {"FIELDS x y z\nPOINTS " + points + "\nDATA " + data + "\n1 2 3\n", "too early for the " + points});
  }
  check_refused("a.pcd", cases, "VERSION .7\n");
  const auto compressed = [](std::uint32_t small, std::uint32_t large, std::size_t bytes) {
    return (Bytes() << small << large).str() + std::string(bytes, '\0');
  };
  const std::string head = pcd_header(kFields, 100, "binary_compressed");
  check_refused("a.pcd",
                {{compressed(20, 1201, 20), "1201 uncompressed bytes are not 100 points of 12 bytes"},
                 {compressed(13, 1200, 13), "cannot come to the 1200"},
                 {compressed(21, 1200, 20), "too early"}},
                head);
  const ScratchFolder folder;
  const auto file = folder.write("a.pcd", head + compressed(14, 1200, 14));
  CHECK(error_of([&] { open_scan(file, {}); }).empty());
}

TEST_CASE("PCD: columns of a compressed file are joined to rows across buffers and batches", "[io]") {
  const ScratchFolder folder;
  constexpr std::uint32_t kRows = 60'000;
  const std::string fields = "FIELDS x a y z\nSIZE 4 2 8 4\nTYPE U U F F\nCOUNT 1 2 1 1\n";
  Bytes x, a, y, z;
  for (std::uint32_t i = 0; i < kRows; ++i) {
    x << i;
    a << U16{5} << static_cast<U16>(i);
    y << 0.5 * i;
    z << -1.f;
  }
  const auto file = folder.write(
      "a.pcd", pcd_header(fields, kRows, "binary_compressed") + block(x.str() + a.str() + y.str() + z.str()));
  check_rows(file, kRows, [](double i) {
    return std::vector<double>{i, 5, std::fmod(i, 65536), 0.5 * i, -1};
  });
}

TEST_CASE("PCD: too many fields of a compressed file are refused", "[io]") {
  std::string names = "FIELDS x y z";
  for (int i = 0; i < 254; ++i) names += " p" + std::to_string(i);
  const std::string columns(4 * 257, '\0');
  check_refused("a.pcd", {{pcd_header(names + "\n", 1, "binary_compressed") + block(columns), "257 fields"}});
}

TEST_CASE("PCD: a compressed frame of a depth camera is read as PCL wrote it", "[io]") {
  const auto shared = shared_folder();
  if (!shared) return;
  const auto file = *shared / "data/pcd/milk_cartoon_all_small_clorox.pcd";
  if (!fs::exists(file)) return skip("no " + file.string());
  // The expected values: the block unpacked by a script of its own.
  const Table table = read_table(file, 65536);
  CHECK(table.names == Names{"x", "y", "z", "red", "green", "blue", "alpha"});
  REQUIRE(table.rows.size() == 307'200);
  std::size_t finite = 0;
  std::vector<double> sums(7, 0.0);
  for (const auto& row : table.rows) {
    const bool is_finite = std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2]);
    finite += is_finite;
    for (std::size_t i = is_finite ? 0 : 3; i < 7; ++i) sums[i] += row[i];
  }
  CHECK(finite == 241'407);
  CHECK(sums[0] == Approx(2189.215449071402));
  CHECK(sums[1] == Approx(-21377.97890348977));
  CHECK(sums[2] == Approx(218447.3789679408));
  CHECK(std::vector<double>(sums.begin() + 3, sums.end()) ==
        std::vector<double>{24001028, 21760851, 19743536, 78336000});
  CHECK(table.rows[10'814] == std::vector<double>{0.9656456708908081, -0.8480228781700134, 1.9919999837875366,
                                                  0x58, 0x55, 0x44, 255});
  CHECK(table.rows[296'918] == std::vector<double>{0.273725688457489, 0.21966859698295593, 0.515999972820282,
                                                   0x3e, 0x2b, 0x07, 255});
}

TEST_CASE("PCD: zeros behind the rows of a binary file are padding, anything else is data", "[io]") {
  const ScratchFolder folder;
  const std::string zeros(10, '\0');
  std::vector<Wrong> cases = {{crowded_files()[0] + zeros, "more data"}};
  for (const std::size_t encoding : {1, 2}) {
    const std::string whole = crowded_files()[encoding];
    CHECK(read_table(folder.write("a.pcd", whole + std::string(5000, '\0'))).rows == kCrowdedRows);
    cases.push_back({whole + zeros + "1", "byte " + std::to_string(whole.size() + 10) + ": more data"});
  }
  check_refused("a.pcd", cases);
}

std::vector<WholeFile> pcd_files() {
  std::vector<WholeFile> files;
  for (const std::string& bytes : crowded_files()) {
    const bool has_last_line = bytes.ends_with('\n');
    files.push_back({.name = "a.pcd",
                     .bytes = bytes,
                     .complete_from = bytes.size() - has_last_line,
                     .points_in_a_byte = kLzfLargestRatio});
  }
  return files;
}

}  // namespace lacuna::test
