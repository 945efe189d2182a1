// SPDX-License-Identifier: Apache-2.0
#include "tests/io/broken_files.hpp"

namespace lacuna::test {
namespace {

const std::string kMesh =
    "# by hand, from C:\\scans\\\nmtllib a.mtl\no thing\nv 1 2 3\nv 4 5 \\\n6\nvt 0 1\nvn 0 0 1\nv 7 8 9\n"
    "vn 0 1 0\nvn 1 0 0\nusemtl grey\ns off\nf 1/1/1 2/1/2 \\\n 3/1/3\n";

// Any beginning may be complete: nothing says how many vertices there are.
std::vector<WholeFile> whole_files() {
  return {{.name = "normals.obj", .bytes = kMesh, .complete_from = 0},
          {.name = "colours.obj",
           .bytes = "v 1 2 3 0.5 0 1\nv 4.5 -5e-1 6 1 1 0.25 # a vertex\nv 7 8 9 0 0 0\nf 1 2 -1\n",
           .complete_from = 0}};
}

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

TEST_CASE("OBJ: a wrong vertex is an error that names its line", "[io]") {
  check_refused("a.obj", {{"v 1 2 3\nv 1 2\n", "line 2: fewer values than needed; 'v x y z'"},
                          {"v 1 2 3\n\nv 1 two 3\n", "line 3: 'two' is not a number"},
                          {"v 1 2 3\nv 1 2 3 4 5\n", "line 2: more values"},
                          {"v 1 2 3\nv 1 2 3 w\n", "line 2: 'w' is not a number"},
                          {"v 1 2 3\nv 1 2 3 4 5 6\n", "line 2: a vertex with a colour"},
                          {"v 1 2 3 4 5 6\nv 1 2 3\n", "line 2: fewer values than needed"},
                          {"v 1 2 3 4 5 6 7\n", "line 1: more values"},
                          {"v 1 2 3\nvn 1 2\n", "line 2: fewer values than needed; 'vn x y z'"},
                          {"v 1 2 3\nvn 1 2 3 4\n", "line 2: more values"}});
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

TEST_CASE("OBJ: a broken file gives one error or whole vertices", "[io]") {
  check_broken_files(whole_files(), 5);
}

TEST_CASE("OBJ: many broken files give one error or whole vertices", "[io][.slow]") {
  check_many_broken_files(whole_files(), 5);
}

}  // namespace lacuna::test
