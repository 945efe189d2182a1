// SPDX-License-Identifier: Apache-2.0
// What holds for every format. It is known by its first bytes, a broken file gives one error or all its
// points, and a wrong row names its line. The corners of a format are in its own test.
#include "tests/io/broken_files.hpp"
#include "tests/support/las_file.hpp"

#include <unistd.h>

namespace lacuna::test {
namespace {

// Small files of a format, and more of them for the slow test. The changes have this seed.
struct Format {
  std::uint32_t seed;
  std::vector<WholeFile> (*files)();
  std::vector<WholeFile> (*more_files)();
};

const std::vector<Format> kFormats = {{1, ply_files, ply_files},   {3, pcd_files, pcd_files},
                                      {5, obj_files, obj_files},   {7, ptx_files, ptx_files},
                                      {8, text_files, text_files}, {9, some_las_files, all_las_files},
                                      {10, e57_files, e57_files}};

TEST_CASE("each format: a broken file gives one error or all its points", "[io]") {
  for (const Format& format : kFormats) check_broken_files(format.files(), format.seed);
}

TEST_CASE("each format: many broken files give one error or all their points", "[io][.slow]") {
  for (const Format& format : kFormats) check_many_broken_files(format.more_files(), format.seed);
}

TEST_CASE("each format of text: a wrong row is an error that names its line", "[io]") {
  const std::string labelled = "FIELDS x y z label\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 1\n";
  const std::string listed = vertices(2) + "property uchar red\nproperty list char int near\n";
  check_refused("a.ply",
                {{"1 2 3 255 0\n1 2 3 256 0\n", "line 11: '256' for property 'red'"},
                 {"1 2 3 255 0\n1 2 3 2.5 0\n", "line 11: '2.5'"},
                 {"1 2 3 255 0\n1 two 3 2 0\n", "line 11: 'two' for property 'y' is not a number"},
                 {"1 2 3 255 0\n1 2x 3 2 0\n", "line 11: '2x'"},
                 {"1 2 3 255 -1\n1 2 3 2 0\n", "line 10: '-1'"},
                 {"1 2 3 255 2 1\n1 2 3 2 0\n", "line 10: fewer values"},
                 {"1 2 3 255 0 9\n1 2 3 2 0\n", "line 10: more values"},
                 {"1 2 3 255 0\n\n# 2 2 3 2 0", "line 12: '#'"}},
                ply_header(listed));
  check_refused("a.pcd",
                {{"1 2 3 4\n1 2 3 256\n", "line 13: '256' is not a whole number from 0 to 255"},
                 {"1 2 3 4\n1 two 3 4\n", "line 13: 'two' is not a number"},
                 {"1 2 3\n1 2 3 4 \n\n", "line 12: fewer values"},
                 {"1 2 3 4\n1 2 3 4 5\n", "line 13: more values than needed, from '5' on"},
                 {"1 2 3 4\n1 2 3 4\n1 2 3 4\n", "more data after the last row"},
                 {"1 2 3 4444\n\n\n\n\n\n\n\n", "line 12: '4444'"},
                 {"1 2 3 4\n\n\n\n\n\n\n\n", "fewer rows than the 2"}},
                pcd_header(labelled, 2, "ascii"));
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

// ---- Which format a file has

TEST_CASE("what cannot be opened is an error that names it", "[io]") {
  const ScratchFolder folder;
  const auto refused = [](const fs::path& file, const std::string& reason) {
    CHECK_THAT(read_error(file), Contains(file.string() + ": ") && Contains(reason));
  };
  refused(folder / "none.ply", "cannot be opened: No such file");
  refused(folder.path(), "is a folder");
  refused("/dev/zero", "not a regular file");
  refused(folder.write("empty.ply", ""), "byte 0: the file is empty");
  const auto locked = folder.write("locked.ply", "1 2 3\n");
  fs::permissions(locked, fs::perms::none);
  if (::geteuid() != 0) refused(locked, "Permission denied");
}

TEST_CASE("a format is known by its first bytes, not by its name", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.ply", "1 2 3\n")).rows.size() == 1);
  CHECK(read_table(folder.write("a.xyz", ascii_ply(""))).rows.empty());
  check_refused("a.las", {{std::string("\x7f\1\0\0\1\2", 6), "unknown format; PLY, LAS"}});
}

TEST_CASE("a format that is known but not read is named, with a way out", "[io]") {
  using namespace std::string_literals;
  check_refused("a.bin", {{"CCB2\1\0\0\0", "byte 0: this is CloudCompare's BIN, which is not read; Cloud"},
                          {"\x1f\x8b\x08", "packed by gzip"},
                          {"\x1f\x8b\x08", "unpack it first"},
                          {"ncols 3\nnrows 3\n", "a grid of Esri"},
                          {"  0\r\nSECTION\r\n", "this is DXF"},
                          {"DRACO\2\2", "this is Draco"},
                          {"PAR1\25", "this is Parquet"},
                          {"STOFF\n4 0 0\n", "this is OFF, which is not read; MeshLab"},
                          {"OFF 4 0 0\n", "this is OFF"},
                          {"{\"type\": \"FeatureCollection\"}",
                           "this is JSON, which is not read; of points of GeoJSON"},
                          {"# vtk DataFile Version 3.0\n", "VTK"},
                          {"version https://git-lfs.github.com/spec/v1\noid sha256:1\n", "git lfs pull"},
                          {"\xff\xfe\x31\0 \0"s, "text in UTF-16"},
                          {"\xfe\xff\0\x31"s, "saves it as UTF-8"}});
  check_refused("a.npz", {{"PK\3\4", "an archive of NumPy"}});
  check_refused("a.npy",
                {{"\x93NUMPY\1\0v", "an array of NumPy, which is not read; lacuna.find_holes of Python"}});
  check_refused("a.stl", {{std::string(84, '\0'), "unknown format; PLY, LAS"}});
  check_refused("a", {{"SOLID a\n FACET NORMAL 0 0 1\n", "this is STL"}});
  for (const auto& [name, format] : {std::pair{"a.rcp", "Autodesk ReCap"},
                                     {"a.fls", "a scan of FARO"},
                                     {"a.rdbx", "a scan of RIEGL"},
                                     {"a.zfs", "Zoller + Froehlich"}})
    check_refused(name, {{"anything", format}});
  CHECK_THAT(read_error("https://host/a.laz"), Contains("is an address"));
}

}  // namespace
}  // namespace lacuna::test
