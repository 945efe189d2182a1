// SPDX-License-Identifier: Apache-2.0
#include "tests/io/broken_files.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

namespace lacuna::test {
using namespace io;

namespace {

using Rows = std::vector<std::vector<double>>;

std::string header(const std::string& format, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + body + "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string format_of(std::endian order) {
  return order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
}

// A vertex with everything around it: an element before and after, each with a list, and a list inside.
const std::string kCrowded =
    "comment made by hand\nobj_info nothing\n"
    "element camera 2\nproperty uchar id\nproperty list uchar double matrix\n"
    "element vertex 2\nproperty short x\nproperty list int8 int16 near\nproperty float32 y\nproperty double "
    "z\n"
    "element face 3\nproperty list uchar int vertex_indices\nproperty uchar flag\n"
    "element edge 1\nproperty int vertex1\nproperty int vertex2\n";

std::string crowded_binary(std::endian order) {
  Bytes bytes(order);
  using U8 = std::uint8_t;
  using I16 = std::int16_t;
  bytes << U8{7} << U8{2} << 1.5 << 2.5 << U8{8} << U8{0};
  bytes << I16{-300} << std::int8_t{2} << I16{1} << I16{2} << 0.5f << 1e300;
  bytes << I16{301} << std::int8_t{0} << -0.25f << 2.0;
  bytes << U8{3} << 0 << 1 << 0 << U8{1} << U8{0} << U8{2} << U8{1} << 5 << U8{9};
  bytes << 0 << 1;
  return header(format_of(order), kCrowded) + bytes.str();
}

const std::string kCrowdedAscii = header("ascii", kCrowded) +
                                  "7 2 1.5 2.5\n8 0\n-300 2 1 2 0.5 1e300\n301 0 -0.25 2\n"
                                  "3 0 1 0 1\n0 2\n1 5 9\n0 1\n";

const Rows kCrowdedRows = {{-300, 0.5, 1e300}, {301, -0.25, 2}};

// A camera at 2.5 -3 0.5, of several types.
const std::string kCamera =
    "element camera 1\nproperty uchar id\nproperty float view_px\nproperty float view_py\n"
    "property double view_pz\n";
const std::string kPoints = "element vertex 2\n" + kXyz;
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";

std::string camera_bytes(std::endian order) {
  return (Bytes(order) << std::uint8_t{1} << 2.5f << -3.f << 0.5).str();
}

std::string points_bytes(std::endian order) {
  return (Bytes(order) << 1.f << 2.f << 3.f << 4.f << 5.f << 6.f).str();
}

std::string face_bytes(std::endian order) {
  return (Bytes(order) << std::uint8_t{3} << 0 << 1 << 0).str();
}

// Without its last line's end the text is complete.
std::vector<WholeFile> whole_files() {
  const std::string little = crowded_binary(std::endian::little), big = crowded_binary(std::endian::big);
  const std::string plain = header("ascii", "element vertex 2\n" + kXyz) + "1 2 3\n4 5 6\n";
  const std::string without_lists =
      header("binary_big_endian", "element camera 1\nproperty int id\nelement vertex 1\n" + kXyz) +
      std::string(4 + 12, '\1');
  const std::string camera_first = header("binary_little_endian", kCamera + kPoints) +
                                   camera_bytes(std::endian::little) + points_bytes(std::endian::little);
  const std::string camera_last =
      header("ascii", kPoints + kFaces + kCamera) + "1 2 3\n4 5 6\n3 0 1 0\n1 2.5 -3 7\n";
  return {{.name = "plain.ply", .bytes = plain, .complete_from = plain.size() - 1},
          {.name = "without_lists.ply", .bytes = without_lists, .complete_from = without_lists.size()},
          {.name = "camera_first.ply", .bytes = camera_first, .complete_from = camera_first.size()},
          {.name = "camera_last.ply", .bytes = camera_last, .complete_from = camera_last.size() - 1},
          {.name = "ascii.ply", .bytes = kCrowdedAscii, .complete_from = kCrowdedAscii.size() - 1},
          {.name = "little.ply", .bytes = little, .complete_from = little.size()},
          {.name = "big.ply", .bytes = big, .complete_from = big.size()}};
}

}  // namespace

TEST_CASE("lists and other elements are passed over in every encoding", "[io]") {
  const ScratchFolder folder;
  for (const std::string& content :
       {kCrowdedAscii, crowded_binary(std::endian::little), crowded_binary(std::endian::big)}) {
    const Table table = read_table(folder.write("a.ply", content));
    CHECK(table.names == std::vector<std::string>{"x", "y", "z"});
    CHECK(table.rows == kCrowdedRows);
  }
}

TEST_CASE("a camera before or after the vertices, in every encoding, is the scanner", "[io]") {
  const ScratchFolder folder;
  std::vector<std::string> contents = {
      header("ascii", kCamera + kFaces + kPoints) + "1 2.5 -3 0.5\n3 0 1 0\n1 2 3\n4 5 6\n",
      header("ascii", kPoints + kCamera) + "\n1 2 3\n\n \n4 5 6\n1 2.5 -3 0.5",
      header("ascii", kPoints + kFaces + kCamera) + "1 2 3\n4 5 6\n3 0 1 0\n1 2.5 -3 0.5\n"};
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string points = points_bytes(order), faces = face_bytes(order), camera = camera_bytes(order);
    contents.push_back(header(format_of(order), kCamera + kPoints) + camera + points);
    contents.push_back(header(format_of(order), kPoints + kCamera) + points + camera);
    contents.push_back(header(format_of(order), kPoints + kFaces + kCamera) + points + faces + camera);
  }
  for (const std::string& content : contents) {
    const auto file = folder.write("a.ply", content);
    const auto scanners = open_scan(file, {})->scanners();
    REQUIRE(scanners.size() == 1);
    CHECK(scanners[0].place == Eigen::Vector3d(2.5, -3, 0.5));
    CHECK(scanners[0].axis == Eigen::Vector3d(0, 0, 1));
    CHECK_FALSE(scanners[0].source);
    CHECK(read_table(file).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  }
}

TEST_CASE("a camera at 0 0 0, two of them, or one without a viewpoint states no scanner", "[io]") {
  const ScratchFolder folder;
  const auto scanners_of = [&](const std::string& body, const std::string& rows) {
    return open_scan(folder.write("a.ply", header("ascii", body + kPoints) + rows + "1 2 3\n4 5 6\n"), {})
        ->scanners()
        .size();
  };
  CHECK(scanners_of(kCamera, "1 0 0 1e-9\n") == 1);
  CHECK(scanners_of(kCamera, "1 0 -0 0\n") == 0);
  std::string two = kCamera;
  two.replace(two.find("camera 1"), 8, "camera 2");
  CHECK(scanners_of(two, "1 2 3 4\n1 2 3 4\n") == 0);
  std::string none = kCamera;
  none.replace(none.find("view_py"), 7, "view_qy");
  CHECK(scanners_of(none, "1 2 3 4\n") == 0);
  const std::string list =
      "element camera 1\nproperty float view_px\nproperty float view_py\n"
      "property list uchar float view_pz\n";
  CHECK(scanners_of(list, "1 2 1 4\n") == 0);
}

TEST_CASE("the camera of a file with local coordinates is local, too", "[io]") {
  const ScratchFolder folder;
  const std::string body = "comment lacuna offset 500000 0 10\n" + kCamera + kPoints;
  const auto reader =
      open_scan(folder.write("a.ply", header("ascii", body) + "1 2.5 -3 0.5\n1 2 3\n4 5 6\n"), {});
  REQUIRE(reader->scanners().size() == 1);
  CHECK(reader->scanners()[0].place == Eigen::Vector3d(500'002.5, -3, 10.5));
}

TEST_CASE("a camera that is cut, or not at a place, is an error of one line that names where", "[io]") {
  const ScratchFolder folder;
  const auto error_of_file = [&](const std::string& content) {
    return error_of([&] { open_scan(folder.write("a.ply", content), {}); });
  };
  const auto is_named = [](const std::string& error, const std::string& reason) {
    INFO(error);
    return error.find("a.ply: " + reason) != std::string::npos && error.find('\n') == std::string::npos;
  };
  const std::string ascii = header("ascii", kPoints + kCamera) + "1 2 3\n4 5 6\n";
  CHECK(is_named(error_of_file(ascii + "1 2.5 nan 0.5\n"), "line 15: the camera is at no place"));
  CHECK(is_named(error_of_file(ascii + "1 2.5 1e99 0.5\n"), "line 15: the camera is at no place"));
  CHECK(is_named(error_of_file(ascii + "1 2.5 x 0.5\n"), "line 15: 'x' for property 'view_py'"));
  CHECK(is_named(error_of_file(ascii + "111112222 2.5\n"), "line 15: '111112222' for property 'id'"));
  CHECK(is_named(error_of_file(ascii + "11 2.55555\n"), "line 15: fewer values than element 'camera'"));
  const std::string blank = header("ascii", kPoints + kCamera) + "1 2 3\n" + std::string(20, '\n');
  CHECK(is_named(error_of_file(blank),
                 "line 34: the file ends here, but 1 more of the 2 rows of element 'ver"));
  const std::string head = header("binary_big_endian", kPoints + kCamera);
  const std::string points = points_bytes(std::endian::big), camera = camera_bytes(std::endian::big);
  CHECK(is_named(error_of_file(head + points + camera.substr(0, 16)), "byte"));
  const std::string infinite = (Bytes(std::endian::big) << std::uint8_t{1} << HUGE_VALF << 1.f << 2.0).str();
  CHECK(is_named(error_of_file(head + points + infinite),
                 "byte " + std::to_string(head.size() + points.size()) + ": the camera is at no place"));
}

TEST_CASE("every scalar type keeps its extreme values in every encoding", "[io]") {
  const ScratchFolder folder;
  const std::string names[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  const std::string others[] = {"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
  for (std::size_t t = 0; t < 8; ++t) {
    with_type(static_cast<Scalar>(t), [&](auto zero) {
      using T = decltype(zero);
      const T low = std::numeric_limits<T>::lowest();
      const T high = std::numeric_limits<T>::max();
      const Rows expected = {{1, 2, 3, static_cast<double>(low)}, {4, 5, 6, static_cast<double>(high)}};
      for (const std::string& name : {names[t], others[t]}) {
        const std::string body = "element vertex 2\n" + kXyz + "property " + name + " value\n";
        for (const std::endian order : {std::endian::little, std::endian::big}) {
          Bytes bytes(order);
          bytes << 1.f << 2.f << 3.f << low << 4.f << 5.f << 6.f << high;
          CHECK(read_table(folder.write("a.ply", header(format_of(order), body) + bytes.str())).rows ==
                expected);
        }
        std::ostringstream text;
        text.precision(17);
        text << "1 2 3 " << +low << "\n4 5 6 " << +high << "\n";
        CHECK(read_table(folder.write("a.ply", header("ascii", body) + text.str())).rows == expected);
      }
    });
  }
}

TEST_CASE("a number as text is rounded once, to the type of its property", "[io]") {
  const ScratchFolder folder;
  // Just above halfway between two floats: rounded by way of double, it would come down to 1.
  const std::string tricky = "1.00000005960464477540";
  const auto file = folder.write("a.ply", header("ascii", "element vertex 1\n" + kXyz) + tricky + " +2 -0\n");
  const auto row = read_table(file).rows.at(0);
  CHECK(row[0] == static_cast<double>(std::nextafter(1.0f, 2.0f)));
  CHECK(row[1] == 2);
  CHECK(std::signbit(row[2]));
}

TEST_CASE("what a float cannot hold becomes infinite or zero, and nan and inf are read", "[io]") {
  const ScratchFolder folder;
  const auto file = folder.write(
      "a.ply", header("ascii", "element vertex 2\n" + kXyz) + "1e39 -1e400 1e-60\nnan inf -inf\n");
  const Rows rows = read_table(file).rows;
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(rows.at(0) == std::vector<double>{infinity, -infinity, 0});
  CHECK(std::isnan(rows.at(1)[0]));
  CHECK(rows[1][1] == infinity);
  CHECK(rows[1][2] == -infinity);
}

TEST_CASE("CR LF, blank lines, tabs and a missing last line end are accepted", "[io]") {
  const ScratchFolder folder;
  std::string text = header("ascii", "comment\nelement vertex 2\n" + kXyz) + "1 2 3\n\n  4\t5 6 ";
  CHECK(read_table(folder.write("a.ply", text)).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  std::string dos;
  for (const char c : text) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(read_table(folder.write("b.ply", dos)).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  Bytes bytes;
  bytes << 1.f << 2.f << 3.f;
  std::string binary =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nproperty float x\r\n"
      "property float y\r\nproperty float z\r\nend_header\r\n" +
      bytes.str();
  CHECK(read_table(folder.write("c.ply", binary)).rows == Rows{{1, 2, 3}});
}

TEST_CASE("lines may end with a carriage return alone, as those of Rhinoceros do", "[io]") {
  const ScratchFolder folder;
  const auto with_returns = [](std::string text) {
    std::replace(text.begin(), text.end(), '\n', '\r');
    return text;
  };
  CHECK(read_table(folder.write("a.ply", with_returns(kCrowdedAscii))).rows == kCrowdedRows);
  CHECK(read_table(folder.write("b.ply", with_returns("ply\n" + kCrowdedAscii.substr(4) + "\n \n"))).rows ==
        kCrowdedRows);
  CHECK_THAT(read_error(folder.write("c.ply", with_returns(kCrowdedAscii) + "1\r")),
             Catch::Contains("more data"));
  // The first byte of the rows is a line feed: no part of the header's last line end.
  Bytes bytes;
  bytes << std::int8_t{'\n'} << std::int8_t{'\r'} << std::int8_t{1};
  const std::string head = with_returns(header(
      "binary_little_endian", "element vertex 1\nproperty char x\nproperty char y\nproperty char z\n"));
  CHECK(read_table(folder.write("d.ply", head + bytes.str())).rows == Rows{{'\n', '\r', 1}});
}

TEST_CASE("the comment of Blender 2.4 may lack its keyword", "[io]") {
  const ScratchFolder folder;
  const std::string body = "element vertex 1\n" + kXyz;
  const std::string line = "Created by Blender3D 247 - www.blender.org, source file: a.blend\n";
  CHECK(read_table(folder.write("a.ply", header("ascii", line + body) + "1 2 3\n")).rows == Rows{{1, 2, 3}});
  CHECK_THAT(read_error(folder.write("a.ply", header("ascii", "Created\n" + body) + "1 2 3\n")),
             Catch::Contains("unknown keyword 'Created'"));
}

TEST_CASE("a header without rows is an empty scan", "[io]") {
  const ScratchFolder folder;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    CHECK(read_table(folder.write("a.ply", header(format, "element vertex 0\n" + kXyz))).rows.empty());
  }
  const std::string no_line_end = header("ascii", "element vertex 0\n" + kXyz);
  CHECK(read_table(folder.write("a.ply", no_line_end.substr(0, no_line_end.size() - 1))).rows.empty());
}

TEST_CASE("a count that no file can hold is an error where the data ends", "[io]") {
  const ScratchFolder folder;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const std::string count : {"1000000000000000000", "18446744073709551615", "2"}) {
      for (const std::string list : {"", "property list uchar int near\n"}) {
        const std::string content =
            header(format, "element vertex " + count + "\n" + kXyz + list) + "1 2 3 0\n";
        const std::string error = read_error(folder.write("a.ply", content));
        CHECK(error.find("a.ply: byte " + std::to_string(content.size()) + ": ") != std::string::npos);
        CHECK(error.find(count + " rows") != std::string::npos);
      }
    }
  }
  const std::string behind =
      header("ascii", "element vertex 1\n" + kXyz + "element face 1000000000000000000\n" +
                          "property list uchar int vertex_indices\n") +
      "1 2 3\n";
  CHECK(read_error(folder.write("a.ply", behind)).find("'face'") != std::string::npos);
  const std::string nothing =
      header("ascii", "element void 1000000000000000000\nelement vertex 1\n" + kXyz) + "1 2 3\n";
  CHECK(read_table(folder.write("a.ply", nothing)).rows == Rows{{1, 2, 3}});
}

TEST_CASE("rows beyond the declared count are an error, since their points would be lost", "[io]") {
  const ScratchFolder folder;
  const std::string ascii = header("ascii", "element vertex 1\n" + kXyz) + "1 2 3\n";
  CHECK(read_table(folder.write("a.ply", ascii + "\n \n")).rows.size() == 1);
  CHECK(read_error(folder.write("a.ply", ascii + "4 5 6\n")).find("more data") != std::string::npos);
  Bytes bytes;
  bytes << 1.f << 2.f << 3.f;
  const std::string binary = header("binary_little_endian", "element vertex 1\n" + kXyz) + bytes.str();
  CHECK(read_error(folder.write("a.ply", binary + bytes.str())).find("more data") != std::string::npos);
}

TEST_CASE("a wrong value in a row is an error that names its line", "[io]") {
  const ScratchFolder folder;
  const std::string head =
      header("ascii", "element vertex 2\n" + kXyz + "property uchar red\nproperty list char int near\n");
  const std::pair<std::string, std::string> cases[] = {
      {"1 2 3 255 0\n1 2 3 256 0\n", "line 11: '256' for property 'red' is not a whole number from 0 to 255"},
      {"1 2 3 255 0\n1 2 3 2.5 0\n", "line 11: '2.5'"},
      {"1 2 3 255 0\n1 two 3 2 0\n", "line 11: 'two' for property 'y' is not a number"},
      {"1 2 3 255 0\n1 2x 3 2 0\n", "line 11: '2x'"},
      {"1 2 3 255 -1\n1 2 3 2 0\n", "line 10: '-1'"},
      {"1 2 3 255 2 1\n1 2 3 2 0\n", "line 10: fewer values"},
      {"1 2 3 255 0 9\n1 2 3 2 0\n", "line 10: more values"},
      {"1 2 3 255 0\n\n# 2 2 3 2 0", "line 12: '#'"},
  };
  for (const auto& [rows, expected] : cases) {
    CHECK(read_error(folder.write("a.ply", head + rows)).find("a.ply: " + expected) != std::string::npos);
  }
}

TEST_CASE("a header that says something impossible is an error that names its line", "[io]") {
  const ScratchFolder folder;
  const std::string vertex = "element vertex 0\n" + kXyz;
  const std::pair<std::string, std::string> cases[] = {
      {"ply\nend_header\n", "line 2: no 'format'"},
      {"ply", "line 1: the file ends here"},
      {"plyx\n1 2 3\n", "is neither a header line"},
      {"ply\nformat ascii 2.0\n", "line 2: "},
      {"ply\nformat ebcdic 1.0\n", "line 2: unknown encoding 'ebcdic'"},
      {"ply\nformat ascii 1.0\nformat ascii 1.0\n", "line 3: a second 'format'"},
      {"ply\nformat ascii 1.0\nvertices 5\n", "line 3: unknown keyword 'vertices'"},
      {"ply\nformat ascii 1.0\nproperty float x\n", "line 3: a property before"},
      {"ply\nformat ascii 1.0\nelement vertex -1\n", "line 3: '-1' is not a whole number"},
      {"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n", "line 3: '9999"},
      {"ply\nformat ascii 1.0\nelement vertex\n", "line 3: "},
      {header("ascii", vertex + "property float y\n"), "line 7: a second property 'y'"},
      {header("ascii", vertex + "property list uchar int y\n"), "line 7: a second property 'y'"},
      {header("ascii", vertex + vertex), "line 7: a second element 'vertex'"},
      {header("ascii", vertex + "property half w\n"), "line 7: unknown type 'half'"},
      {header("ascii", vertex + "property list float int w\n"), "line 7: the count of a list"},
      {header("ascii", vertex + "property list uchar w\n"), "line 7: 'property"},
      {header("ascii", "element point 1\n"), "no element 'vertex'"},
      {header("ascii", "element vertex 0\nproperty float x\nproperty float y\n"), "no scalar property 'z'"},
      {header("ascii", "element vertex 0\nproperty float x\nproperty float y\nproperty list uchar int z\n"),
       "no scalar property 'z'"},
  };
  for (const auto& [content, expected] : cases) {
    INFO(content);
    CHECK(read_error(folder.write("a.ply", content)).find(expected) != std::string::npos);
  }
}

TEST_CASE("names of position and normal may be capitals", "[io]") {
  const ScratchFolder folder;
  const std::string capitals =
      "element vertex 1\nproperty float X\nproperty float Y\nproperty double Z\nproperty float NX\n"
      "property float NY\nproperty float NZ\nproperty float Quality\n";
  const Table table = read_table(folder.write("a.ply", header("ascii", capitals) + "1 2 3 4 5 6 7\n"));
  CHECK(table.names == std::vector<std::string>{"x", "y", "z", "nx", "ny", "nz", "Quality"});
  CHECK(table.rows == Rows{{1, 2, 3, 4, 5, 6, 7}});
  const std::string both = "element vertex 1\nproperty float X\n" + kXyz;
  CHECK(read_table(folder.write("a.ply", header("ascii", both) + "9 1 2 3\n")).names ==
        std::vector<std::string>{"X", "x", "y", "z"});
  const std::string twice = "element vertex 1\nproperty float nx\nproperty float NX\n" + kXyz;
  CHECK(read_table(folder.write("a.ply", header("ascii", twice) + "8 9 1 2 3\n")).names ==
        std::vector<std::string>{"nx", "NX", "x", "y", "z"});
}

TEST_CASE("a line 'bye' in a header is passed over and noted", "[io]") {
  const ScratchFolder folder;
  const std::string body = "element vertex 1\nbye\n" + kXyz;
  const auto file = folder.write("a.ply", header("ascii", body) + "1 2 3\n");
  CHECK(read_table(file).rows == Rows{{1, 2, 3}});
  CHECK(open_scan(file, {})->notes().at(0).count == 1);
  CHECK_THAT(read_error(folder.write("a.ply", header("ascii", "bye bye\n" + body) + "1 2 3\n")),
             Catch::Contains("line 3: unknown keyword 'bye'"));
}

TEST_CASE("a header without an end is given up", "[io]") {
  const ScratchFolder folder;
  std::string lines = "ply\nformat ascii 1.0\n";
  while (lines.size() < (2u << 20)) lines += "comment and so on and on and on\n";
  CHECK(read_error(folder.write("a.ply", lines)).find("no 'end_header'") != std::string::npos);
  CHECK(
      read_error(folder.write("a.ply", std::string("ply\n").append(3u << 20, 'x'))).find("line 2: longer") !=
      std::string::npos);
}

TEST_CASE("a list with a negative count, or one that leaves the file, is an error", "[io]") {
  const ScratchFolder folder;
  const std::string head =
      header("binary_big_endian", "element vertex 1\n" + kXyz + "property list int double near\n");
  for (const std::int32_t count : {-1, 1, std::numeric_limits<std::int32_t>::max()}) {
    Bytes bytes(std::endian::big);
    bytes << 1.f << 2.f << 3.f << count;
    const std::string expected = count < 0 ? "list 'near' has a negative count" : "the file ends here";
    const std::string error = read_error(folder.write("a.ply", head + bytes.str()));
    CHECK(error.find("a.ply: byte ") != std::string::npos);
    CHECK(error.find(expected) != std::string::npos);
  }
}

TEST_CASE("rows stay whole across buffers and batches", "[io]") {
  const ScratchFolder folder;
  constexpr std::uint32_t kRows = 150'000;  // several buffers
  const std::string body = "element vertex " + std::to_string(kRows) +
                           "\nproperty uint x\nproperty float y\n"
                           "property double z\n";
  const std::string list = "property list uchar ushort near\n";
  Bytes plain(std::endian::big);
  Bytes listed(std::endian::little);
  std::string ascii;
  for (std::uint32_t i = 0; i < kRows; ++i) {
    plain << i << 0.5f * static_cast<float>(i) << -1.0 * i;
    listed << i << 0.5f * static_cast<float>(i) << -1.0 * i << std::uint8_t{1} << std::uint16_t{5};
    ascii += std::to_string(i) + ' ' + std::to_string(0.5 * i) + " -" + std::to_string(i) + " 1 5\n";
  }
  const std::string contents[] = {header("binary_big_endian", body) + plain.str(),
                                  header("binary_little_endian", body + list) + listed.str(),
                                  header("ascii", body + list) + ascii};
  for (const std::string& content : contents) {
    const auto file = folder.write("a.ply", content);
    for (const std::size_t max_rows : {1u, 1000u, 65536u, 1'000'000u}) {
      const Rows rows = read_table(file, max_rows).rows;
      REQUIRE(rows.size() == kRows);
      bool all = true;
      for (std::uint32_t i = 0; i < kRows; ++i)
        all = all && rows[i] == std::vector<double>{1.0 * i, 0.5 * i, -1.0 * i};
      CHECK(all);
    }
  }
}

TEST_CASE("a list longer than any buffer is passed over", "[io]") {
  const ScratchFolder folder;
  const std::string body =
      "element strips 1\nproperty list int int vertex_indices\nelement vertex 1\n" + kXyz;
  constexpr int kLength = 1'000'000;
  std::string ascii = std::to_string(kLength);
  for (int i = 0; i < kLength; ++i) ascii += " 12";
  CHECK(read_table(folder.write("a.ply", header("ascii", body) + ascii + "\n1 2 3\n")).rows ==
        Rows{{1, 2, 3}});
  CHECK(read_error(folder.write("a.ply", header("ascii", body) + ascii + " 1\n1 2 3\n"))
            .find("line 10: more values") != std::string::npos);
}

TEST_CASE("a batch is bounded in bytes, however many properties a row has", "[io]") {
  const ScratchFolder folder;
  std::string body = "element vertex 4000\n" + kXyz;
  for (int i = 0; i < 4000; ++i) body += "property double p" + std::to_string(i) + "\n";
  const auto file =
      folder.write("a.ply", header("binary_little_endian", body) + std::string(4000u * 32012u, '\0'));
  const auto reader = open_scan(file, {});
  RowBatch batch;
  REQUIRE(reader->next(batch, 65536));
  CHECK(batch.bytes.size() < (40u << 20));
  std::size_t rows = batch.count;
  while (reader->next(batch, 65536)) rows += batch.count;
  CHECK(rows == 4000);
}

TEST_CASE("PLY: a broken file gives one error or all its rows", "[io]") {
  check_broken_files(whole_files(), 1);
}

TEST_CASE("PLY: many broken files give one error or all their rows", "[io][.slow]") {
  check_many_broken_files(whole_files(), 1);
}

}  // namespace lacuna::test
