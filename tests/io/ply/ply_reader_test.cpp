// SPDX-License-Identifier: Apache-2.0
// Vertices of meshes: PLY and OBJ.
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
namespace {

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
  return ply_header(kCrowded, ply_format(order)) + bytes.str();
}

const std::string kCrowdedAscii = ply_header(kCrowded) +
                                  "7 2 1.5 2.5\n8 0\n-300 2 1 2 0.5 1e300\n301 0 -0.25 2\n"
                                  "3 0 1 0 1\n0 2\n1 5 9\n0 1\n";

const Rows kCrowdedRows = {{-300, 0.5, 1e300}, {301, -0.25, 2}};

// A camera at 2.5 -3 0.5, of several types.
const std::string kMixedCamera =
    "element camera 1\nproperty uchar id\nproperty float view_px\nproperty float view_py\n"
    "property double view_pz\n";
const std::string kPoints = vertices(2);

std::string camera_bytes(std::endian order) {
  return (Bytes(order) << std::uint8_t{1} << 2.5f << -3.f << 0.5).str();
}

std::string points_bytes(std::endian order) {
  return (Bytes(order) << 1.f << 2.f << 3.f << 4.f << 5.f << 6.f).str();
}

std::string face_bytes(std::endian order) {
  return (Bytes(order) << std::uint8_t{3} << 0 << 1 << 0).str();
}

}  // namespace

TEST_CASE("lists and other elements are passed over in every encoding", "[io]") {
  const ScratchFolder folder;
  for (const std::string& content :
       {kCrowdedAscii, crowded_binary(std::endian::little), crowded_binary(std::endian::big)}) {
    const Table table = read_table(folder.write("a.ply", content));
    CHECK(table.names == Names{"x", "y", "z"});
    CHECK(table.rows == kCrowdedRows);
  }
}

TEST_CASE("a camera before or after the vertices, in every encoding, is the scanner", "[io]") {
  const ScratchFolder folder;
  std::vector<std::string> contents = {
      ply_header(kMixedCamera + kFace + kPoints) + "1 2.5 -3 0.5\n3 0 1 0\n1 2 3\n4 5 6\n",
      ply_header(kPoints + kMixedCamera) + "\n1 2 3\n\n \n4 5 6\n1 2.5 -3 0.5",
      ply_header(kPoints + kFace + kMixedCamera) + "1 2 3\n4 5 6\n3 0 1 0\n1 2.5 -3 0.5\n"};
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string points = points_bytes(order), face = face_bytes(order), camera = camera_bytes(order);
    const std::string format = ply_format(order);
    contents.push_back(ply_header(kMixedCamera + kPoints, format) + camera + points);
    contents.push_back(ply_header(kPoints + kMixedCamera, format) + points + camera);
    contents.push_back(ply_header(kPoints + kFace + kMixedCamera, format) + points + face + camera);
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
  const std::string local = "comment lacuna offset 500000 0 10\n" + kMixedCamera + kPoints;
  const auto file = folder.write("a.ply", ply_header(local) + "1 2.5 -3 0.5\n1 2 3\n4 5 6\n");
  CHECK(open_scan(file, {})->scanners().at(0).place == Eigen::Vector3d(500'002.5, -3, 10.5));
}

TEST_CASE("a camera at 0 0 0, two of them, or one without a viewpoint states no scanner", "[io]") {
  const ScratchFolder folder;
  const auto scanners_of = [&](const std::string& camera, const std::string& rows) {
    return open_scan(folder.write("a.ply", ply_header(camera + kPoints) + rows + "1 2 3\n4 5 6\n"), {})
        ->scanners()
        .size();
  };
  const auto camera_with = [](const std::string& part, const std::string& other) {
    std::string camera = kCamera;
    return camera.replace(camera.find(part), part.size(), other);
  };
  CHECK(scanners_of(kCamera, "0 0 1e-9\n") == 1);
  CHECK(scanners_of(kCamera, "0 -0 0\n") == 0);
  CHECK(scanners_of(camera_with("camera 1", "camera 2"), "2 3 4\n2 3 4\n") == 0);
  CHECK(scanners_of(camera_with("view_py", "view_qy"), "2 3 4\n") == 0);
  CHECK(scanners_of(camera_with("float view_pz", "list uchar float view_pz"), "2 3 1 4\n") == 0);
}

TEST_CASE("a camera that is cut, or not at a place, is an error of one line that names where", "[io]") {
  check_refused("a.ply",
                {{"1 2.5 nan 0.5\n", "a.ply: line 15: the camera is at no place"},
                 {"1 2.5 1e99 0.5\n", "line 15: the camera is at no place"},
                 {"1 2.5 x 0.5\n", "line 15: 'x' for property 'view_py'"},
                 {"111112222 2.5\n", "line 15: '111112222' for property 'id'"},
                 {"11 2.55555\n", "line 15: fewer values than element 'camera'"}},
                ply_header(kPoints + kMixedCamera) + "1 2 3\n4 5 6\n");
  const std::string head = ply_header(kPoints + kMixedCamera, "binary_big_endian");
  const std::string points = points_bytes(std::endian::big), camera = camera_bytes(std::endian::big);
  const std::string infinite = (Bytes(std::endian::big) << std::uint8_t{1} << HUGE_VALF << 1.f << 2.0).str();
  const std::string place = "byte " + std::to_string(head.size() + points.size());
  check_refused("a.ply", {{ply_header(kPoints + kMixedCamera) + "1 2 3\n" + std::string(20, '\n'),
                           "line 34: the file ends here, but 1 more of the 2 rows of element 'ver"},
                          {head + points + camera.substr(0, 16), "byte"},
                          {head + points + infinite, place + ": the camera is at no place"}});
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
        const std::string body = kPoints + "property " + name + " value\n";
        std::ostringstream text;
        text.precision(17);
        text << "1 2 3 " << +low << "\n4 5 6 " << +high << "\n";
        CHECK(read_table(folder.write("a.ply", ply_header(body) + text.str())).rows == expected);
        for (const std::endian order : {std::endian::little, std::endian::big}) {
          Bytes bytes(order);
          bytes << 1.f << 2.f << 3.f << low << 4.f << 5.f << 6.f << high;
          const std::string content = ply_header(body, ply_format(order)) + bytes.str();
          CHECK(read_table(folder.write("a.ply", content)).rows == expected);
        }
      }
    });
  }
}

TEST_CASE("a number as text is rounded once, to the type of its property", "[io]") {
  const ScratchFolder folder;
  // Just above halfway between two floats: rounded by way of double, it would come down to 1.
  const std::string tricky = "1.00000005960464477540";
  const Rows rows =
      read_table(folder.write("a.ply", ascii_ply(tricky + " +2 -0\n1e39 -1e400 1e-60\nnan inf -inf\n"))).rows;
  CHECK(rows.at(0)[0] == static_cast<double>(std::nextafter(1.0f, 2.0f)));
  CHECK(rows[0][1] == 2);
  CHECK(std::signbit(rows[0][2]));
  // What a float cannot hold becomes infinite or zero.
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(rows[1] == std::vector<double>{infinity, -infinity, 0});
  CHECK(std::isnan(rows[2][0]));
  CHECK((rows[2][1] == infinity && rows[2][2] == -infinity));
}

TEST_CASE("CR LF, blank lines, tabs and a missing last line end are accepted", "[io]") {
  const ScratchFolder folder;
  const std::string text = ply_header("comment\n" + kPoints) + "1 2 3\n\n  4\t5 6 ";
  const std::string head = ply_header(vertices(1), "binary_little_endian");
  const std::string row = (Bytes() << 1.f << 2.f << 3.f).str();
  const auto dos = [](const std::string& lines) {
    std::string dos;
    for (const char c : lines) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return dos;
  };
  CHECK(read_table(folder.write("a.ply", text)).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read_table(folder.write("b.ply", dos(text))).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  CHECK(read_table(folder.write("c.ply", dos(head) + row)).rows == Rows{{1, 2, 3}});
}

TEST_CASE("lines may end with a carriage return alone, as Rhinoceros writes them", "[io]") {
  const ScratchFolder folder;
  const auto with_returns = [](std::string text) {
    std::replace(text.begin(), text.end(), '\n', '\r');
    return text;
  };
  CHECK(read_table(folder.write("a.ply", with_returns(kCrowdedAscii))).rows == kCrowdedRows);
  CHECK(read_table(folder.write("b.ply", with_returns("ply\n" + kCrowdedAscii.substr(4) + "\n \n"))).rows ==
        kCrowdedRows);
  CHECK_THAT(read_error(folder.write("c.ply", with_returns(kCrowdedAscii) + "1\r")), Contains("more data"));
  // The first byte of the rows is a line feed: no part of the header's last line end.
  Bytes bytes;
  bytes << std::int8_t{'\n'} << std::int8_t{'\r'} << std::int8_t{1};
  const std::string head = with_returns(
      ply_header(vertices(1, "property char x\nproperty char y\nproperty char z\n"), "binary_little_endian"));
  CHECK(read_table(folder.write("d.ply", head + bytes.str())).rows == Rows{{'\n', '\r', 1}});
}

TEST_CASE("a comment of Blender 2.4 without its keyword, and a line 'bye', are passed over", "[io]") {
  const ScratchFolder folder;
  const std::string blender = "Created by Blender3D 247 - www.blender.org, source file: a.blend\n";
  CHECK(read_table(folder.write("a.ply", ply_header(blender + vertices(1)) + "1 2 3\n")).rows ==
        Rows{{1, 2, 3}});
  const auto file = folder.write("a.ply", ply_header("element vertex 1\nbye\n" + kXyz) + "1 2 3\n");
  CHECK(read_table(file).rows == Rows{{1, 2, 3}});
  CHECK(open_scan(file, {})->notes().at(0).count == 1);
}

TEST_CASE("a header without rows is an empty scan", "[io]") {
  const ScratchFolder folder;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"})
    CHECK(read_table(folder.write("a.ply", ply_header(vertices(0), format))).rows.empty());
  const std::string no_line_end = ascii_ply("");
  CHECK(read_table(folder.write("a.ply", no_line_end.substr(0, no_line_end.size() - 1))).rows.empty());
}

TEST_CASE("a count that no file can hold is an error where the data ends", "[io]") {
  std::vector<Wrong> cases;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const std::string count : {"1000000000000000000", "18446744073709551615", "2"}) {
      for (const std::string list : {"", "property list uchar int near\n"}) {
        const std::string content =
            ply_header("element vertex " + count + "\n" + kXyz + list, format) + "1 2 3 0\n";
        cases.push_back({content, "byte " + std::to_string(content.size()) + ": "});
        cases.push_back({content, count + " rows"});
      }
    }
  }
  const std::string faces = "element face 1000000000000000000\nproperty list uchar int vertex_indices\n";
  cases.push_back({ply_header(vertices(1) + faces) + "1 2 3\n", "'face'"});
  check_refused("a.ply", cases);
  const ScratchFolder folder;
  const std::string nothing = ply_header("element void 1000000000000000000\n" + vertices(1)) + "1 2 3\n";
  CHECK(read_table(folder.write("a.ply", nothing)).rows == Rows{{1, 2, 3}});
}

TEST_CASE("rows beyond the declared count are an error, since their points would be lost", "[io]") {
  const std::string row = (Bytes() << 1.f << 2.f << 3.f).str();
  check_refused("a.ply", {{ascii_ply("1 2 3\n") + "4 5 6\n", "more data"},
                          {ply_header(vertices(1), "binary_little_endian") + row + row, "more data"}});
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.ply", ascii_ply("1 2 3\n") + "\n \n")).rows.size() == 1);
}

TEST_CASE("a header that says something impossible is an error that names its line", "[io]") {
  const std::string ascii = "ply\nformat ascii 1.0\n", vertex = ascii + vertices(0);
  std::string endless = ascii;
  while (endless.size() < (2u << 20)) endless += "comment and so on and on and on\n";
  check_refused("a.ply", {{"ply\nend_header\n", "line 2: no 'format'"},
                          {"ply", "line 1: the file ends here"},
                          {"plyx\n1 2 3\n", "is neither a header line"},
                          {"ply\nformat ascii 2.0\n", "line 2: "},
                          {"ply\nformat ebcdic 1.0\n", "line 2: unknown encoding 'ebcdic'"},
                          {ascii + "format ascii 1.0\n", "line 3: a second 'format'"},
                          {ascii + "vertices 5\n", "line 3: unknown keyword 'vertices'"},
                          {ascii + "Created\n", "line 3: unknown keyword 'Created'"},
                          {ascii + "bye bye\n", "line 3: unknown keyword 'bye'"},
                          {ascii + "property float x\n", "line 3: a property before"},
                          {ascii + "element vertex -1\n", "line 3: '-1' is not a whole number"},
                          {ascii + "element vertex 99999999999999999999\n", "line 3: '9999"},
                          {ascii + "element vertex\n", "line 3: "},
                          {vertex + "property float y\n", "line 7: a second property 'y'"},
                          {vertex + "property list uchar int y\n", "line 7: a second property 'y'"},
                          {vertex + vertices(0), "line 7: a second element 'vertex'"},
                          {vertex + "property half w\n", "line 7: unknown type 'half'"},
                          {vertex + "property list float int w\n", "line 7: the count of a list"},
                          {vertex + "property list uchar w\n", "line 7: 'property"},
                          {ply_header("element sample 1\n"), "no element 'vertex'"},
                          {ply_header(vertices(0, "property float x\nproperty float y\n")), "property 'z'"},
                          {ply_header(vertices(0,
                                               "property float x\nproperty float y\n"
                                               "property list uchar int z\n")),
                           "no scalar property 'z'"},
                          {endless, "no 'end_header'"},
                          {std::string("ply\n").append(3u << 20, 'x'), "line 2: longer"}});
}

TEST_CASE("points of PLY may be elements of other names, and truths are bytes", "[io]") {
  const ScratchFolder folder;
  for (const std::string name : {"vertices", "point", "points"}) {
    const std::string rest = " 1\n" + kXyz + "property bool seen\n";
    const Table table = read_table(folder.write("a.ply", ply_header("element " + name + rest) + "1 2 3 1\n"));
    CHECK(table.rows == std::vector<std::vector<double>>{{1, 2, 3, 1}});
  }
}

TEST_CASE("names of position and normal may be capitals", "[io]") {
  const ScratchFolder folder;
  const auto read = [&](const std::string& properties, const std::string& row) {
    return read_table(folder.write("a.ply", ascii_ply(row, properties)));
  };
  const Table table = read(
      "property float X\nproperty float Y\nproperty double Z\nproperty float NX\nproperty float NY\n"
      "property float NZ\nproperty float Quality\n",
      "1 2 3 4 5 6 7\n");
  CHECK(table.names == Names{"x", "y", "z", "nx", "ny", "nz", "Quality"});
  CHECK(table.rows == Rows{{1, 2, 3, 4, 5, 6, 7}});
  CHECK(read("property float X\n" + kXyz, "9 1 2 3\n").names == Names{"X", "x", "y", "z"});
  CHECK(read("property float nx\nproperty float NX\n" + kXyz, "8 9 1 2 3\n").names ==
        Names{"nx", "NX", "x", "y", "z"});
}

TEST_CASE("a list with a negative count, or one that leaves the file, is an error", "[io]") {
  const auto row = [](std::int32_t count) {
    return (Bytes(std::endian::big) << 1.f << 2.f << 3.f << count).str();
  };
  check_refused("a.ply",
                {{row(-1), "list 'near' has a negative count"},
                 {row(1), "byte "},
                 {row(1), "the file ends here"},
                 {row(std::numeric_limits<std::int32_t>::max()), "the file ends here"}},
                ply_header(vertices(1) + "property list int double near\n", "binary_big_endian"));
}

TEST_CASE("rows stay whole across buffers and batches", "[io]") {
  const ScratchFolder folder;
  constexpr std::uint32_t kRows = 150'000;  // several buffers
  const std::string body = vertices(kRows, "property uint x\nproperty float y\nproperty double z\n");
  const std::string list = "property list uchar ushort near\n";
  Bytes plain(std::endian::big);
  Bytes listed(std::endian::little);
  std::string ascii;
  for (std::uint32_t i = 0; i < kRows; ++i) {
    plain << i << 0.5f * static_cast<float>(i) << -1.0 * i;
    listed << i << 0.5f * static_cast<float>(i) << -1.0 * i << std::uint8_t{1} << std::uint16_t{5};
    ascii += std::to_string(i) + ' ' + std::to_string(0.5 * i) + " -" + std::to_string(i) + " 1 5\n";
  }
  for (const std::string& content :
       {ply_header(body, "binary_big_endian") + plain.str(),
        ply_header(body + list, "binary_little_endian") + listed.str(), ply_header(body + list) + ascii}) {
    check_rows(folder.write("a.ply", content), kRows, [](double i) {
      return std::vector<double>{i, 0.5 * i, -i};
    });
  }
}

TEST_CASE("a list longer than any buffer is passed over", "[io]") {
  const ScratchFolder folder;
  const std::string head =
      ply_header("element strips 1\nproperty list int int vertex_indices\n" + vertices(1));
  constexpr int kLength = 1'000'000;
  std::string list = std::to_string(kLength);
  for (int i = 0; i < kLength; ++i) list += " 12";
  CHECK(read_table(folder.write("a.ply", head + list + "\n1 2 3\n")).rows == Rows{{1, 2, 3}});
  check_refused("a.ply", {{head + list + " 1\n1 2 3\n", "line 10: more values"}});
}

// Without its last line's end the text is complete.
std::vector<WholeFile> ply_files() {
  const std::string little = crowded_binary(std::endian::little), big = crowded_binary(std::endian::big);
  const std::string plain = ascii_ply("1 2 3\n4 5 6\n");
  const std::string without_lists =
      ply_header("element camera 1\nproperty int id\n" + vertices(1), "binary_big_endian") +
      std::string(4 + 12, '\1');
  const std::string camera_first = ply_header(kMixedCamera + kPoints, "binary_little_endian") +
                                   camera_bytes(std::endian::little) + points_bytes(std::endian::little);
  const std::string camera_last =
      ply_header(kPoints + kFace + kMixedCamera) + "1 2 3\n4 5 6\n3 0 1 0\n1 2.5 -3 7\n";
  return {{.name = "plain.ply", .bytes = plain, .complete_from = plain.size() - 1},
          {.name = "without_lists.ply", .bytes = without_lists, .complete_from = without_lists.size()},
          {.name = "camera_first.ply", .bytes = camera_first, .complete_from = camera_first.size()},
          {.name = "camera_last.ply", .bytes = camera_last, .complete_from = camera_last.size() - 1},
          {.name = "ascii.ply", .bytes = kCrowdedAscii, .complete_from = kCrowdedAscii.size() - 1},
          {.name = "little.ply", .bytes = little, .complete_from = little.size()},
          {.name = "big.ply", .bytes = big, .complete_from = big.size()}};
}

namespace {

// ---- OBJ

const std::string kMesh =
    "# by hand, from C:\\scans\\\nmtllib a.mtl\no thing\nv 1 2 3\nv 4 5 \\\n6\nvt 0 1\nvn 0 0 1\nv 7 8 9\n"
    "vn 0 1 0\nvn 1 0 0\nusemtl grey\ns off\nf 1/1/1 2/1/2 \\\n 3/1/3\n";

}  // namespace

TEST_CASE("OBJ: vertices are rows, other lines are skipped", "[io]") {
  const ScratchFolder folder;
  const auto file = folder.write("a.txt", "\n# one\nmtllib a.mtl\ng\nv 1 2 3\n\tv  -4 5e0 6 \r\nf 1 2 1\n");
  const Table table = read_table(file, 1);
  CHECK(table.names == Names{"x", "y", "z"});
  CHECK(table.rows == Rows{{1, 2, 3}, {-4, 5, 6}});
  CHECK(open_scan(file, {})->format() == "OBJ");
  CHECK(open_scan(file, {})->expected_rows() == 2u);
  CHECK(open_scan(file, {})->layout().find("x")->type == Scalar::kFloat64);
}

TEST_CASE("OBJ: a weight is left out, and three more values are a colour", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.obj", "v 1 2 3 1.0\nv 4 5 6\n")).rows == Rows{{1, 2, 3}, {4, 5, 6}});
  const Table coloured = read_table(folder.write("a.obj", "v 1 2 3 0.5 0 1\nv 4 5 6 1 1 0.25"));
  CHECK(coloured.names == Names{"x", "y", "z", "red", "green", "blue"});
  CHECK(coloured.rows == Rows{{1, 2, 3, 0.5, 0, 1}, {4, 5, 6, 1, 1, 0.25}});
}

TEST_CASE("OBJ: a line goes on behind a backslash, but a comment does not", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.obj", "v 1\\\n2 \\ \r\n3 \\\n\nf 1 \\\n v 4 5 6\n")).rows ==
        Rows{{1, 2, 3}});
  std::string endless = "v 1 2 3\nf";
  for (int i = 0; i < 200'000; ++i) endless += " 1 1 1\\\n";
  check_refused("a.obj", {{endless, "bytes allowed"}});
}

TEST_CASE("OBJ: normals are read if each is of the vertex with its number", "[io]") {
  const ScratchFolder folder;
  const Table table = read_table(folder.write("a.obj", kMesh), 2);
  CHECK(table.names == Names{"x", "y", "z", "nx", "ny", "nz"});
  CHECK(table.rows == Rows{{1, 2, 3, 0, 0, 1}, {4, 5, 6, 0, 1, 0}, {7, 8, 9, 1, 0, 0}});
  const auto names = [&](const std::string& content) {
    return read_table(folder.write("a.obj", content)).names.size();
  };
  const std::string two = "v 1 2 3\nv 4 5 6\nvn 0 0 1\n";
  CHECK(names(two) == 3);
  CHECK(names(two + "vn 0 1 0\n") == 6);
  CHECK(names(two + "vn 0 1 0\nvn 1 0 0\n") == 3);
  CHECK(names(two + "vn 0 1 0\nf 1 2 1\nf 1/9 2/9 1/9\n") == 6);
  CHECK(names(two + "vn 0 1 0\nf 1//1 2//2 1//1\n") == 6);
  CHECK(names(two + "vn 0 1 0\nf -2//-2 -1/4/-1 -2//1\n") == 6);
  CHECK(names(two + "vn 0 1 0\nf 1//1 2//1 1//1\n") == 3);  // the normal of the face
  CHECK(names(two + "vn 0 1 0\nf -2/1/-1 2//2 1//1\n") == 3);
}

TEST_CASE("OBJ: points as text are not taken for it, and it is not taken for points", "[io]") {
  const ScratchFolder folder;
  const auto format = [&](const std::string& content) {
    return open_scan(folder.write("a", content), {})->format();
  };
  CHECK(format("1 2 3\n4 5 6\n") == "text");
  CHECK(format("x y z v\n1 2 3 4\n") == "text");
  CHECK(format("v x y z\n0 1 2 3\n") == "text");
  CHECK(format("# v 1 2 3\n1 2 3\n") == "text");
  CHECK(format("v 1 2 3") == "OBJ");
  CHECK(format("#\n\n  v 1 2 3\n") == "OBJ");
  // The first bytes end within a line.
  for (std::size_t length = 4080; length < 4100; ++length) {
    CHECK(format("v 1 2 3\n#" + std::string(length, '#') + "\nusemtl " + std::string(60, 'a') + "\n") ==
          "OBJ");
  }
}

TEST_CASE("OBJ: rows stay whole across buffers and batches", "[io]") {
  const ScratchFolder folder;
  constexpr int kRows = 60'000;
  std::string content;
  for (int i = 0; i < kRows; ++i)
    content += "v " + std::to_string(i) + " 0.5 -1 # a vertex\nvt 0.123456 0.654321\n";
  content += "unheard of\n";  // far from the first bytes
  for (int i = 0; i < kRows; ++i) content += "vn 0 0 " + std::to_string(i) + "\n";
  check_rows(folder.write("a.obj", content), kRows,
             [](double i) { return std::vector<double>{i, 0.5, -1, 0, 0, i}; });
}

// Any beginning may be complete: nothing says how many vertices there are.
std::vector<WholeFile> obj_files() {
  return {{.name = "normals.obj", .bytes = kMesh, .complete_from = 0},
          {.name = "colours.obj",
           .bytes = "v 1 2 3 0.5 0 1\nv 4.5 -5e-1 6 1 1 0.25 # a vertex\nv 7 8 9 0 0 0\nf 1 2 -1\n",
           .complete_from = 0}};
}

}  // namespace lacuna::test
