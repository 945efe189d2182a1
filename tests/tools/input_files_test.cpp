// SPDX-License-Identifier: Apache-2.0
#include "tools/run/input_files.hpp"

#include "io/read/scan/scan_files.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::tools {
using namespace io;

namespace {

using Paths = std::vector<fs::path>;

Paths files_of(const std::vector<fs::path>& given) {
  Paths files;
  for (const ScanInput& input : expand_inputs(given)) files.push_back(input.name);
  return files;
}

fs::path as_list(const std::string& file) {
  std::string name = "@";
  name += file;
  return name;
}

void check_list_refused(const std::string& lines, const std::string& part) {
  const ScratchFolder scratch;
  CHECK_THROWS_WITH(expand_inputs({as_list(scratch.write("list.txt", lines))}, {}), Contains(part));
}

TEST_CASE("a folder stands for its scans by name, a list for the files in it, all else for itself") {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "in" / "deeper");
  const fs::path in = scratch / "in";
  const std::string rows = "1 2 3\n4 5 6\n";
  const auto b = scratch.write("in/b.xyz", rows), a = scratch.write("in/a.ply", test::ascii_ply(""));
  const auto broken = scratch.write("in/c.ply", "ply\nbroken\n");
  scratch.write("in/.hidden.xyz", rows);
  scratch.write("in/README.txt", "These are scans.\n");
  scratch.write("in/photo.jpg", std::string("\xff\xd8\xff\0\0", 5));
  scratch.write("in/empty.xyz", "");
  scratch.write("in/deeper/d.xyz", rows);
  // A broken file of a format that is read is an error later, not passed over.
  CHECK(files_of({in}) == Paths{a, broken});  // b.xyz is text in a folder of binary scans
  CHECK(files_of({b, in / "deeper", "missing.ply"}) == Paths{b, in / "deeper" / "d.xyz", "missing.ply"});

  // With a byte order mark, and quotes as some programs write them.
  const auto list = scratch.write("list.txt", "\xef\xbb\xbf# two\r\nin/b.xyz\r\n\n\"in/deeper/d.xyz\"\n");
  CHECK(files_of({as_list(list)}) == Paths{scratch / "in/b.xyz", scratch / "in/deeper/d.xyz"});
}

TEST_CASE("results in a folder are no scans, unless they are named") {
  const ScratchFolder scratch;
  fs::create_directory(scratch / "holes");
  const auto scan = scratch.write("a.ply", test::ascii_ply("")),
             loops = scratch.write("holes/loops.ply", test::ascii_ply(""));
  scratch.write("holes/.lacuna", "loops.ply\n");
  FilesConfig config;
  config.input.recursive = true;
  CHECK(expand_inputs({scratch.path()}, config).size() == 1);
  CHECK(files_of({loops}) == Paths{loops});
  CHECK_THROWS_WITH(files_of({scratch / "holes"}), Contains("no scan file in this folder"));
}

TEST_CASE("text with binary scans is not read, and options read deeper folders and leave out damaged files") {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "in" / "deeper");
  const std::string ply = test::ascii_ply("");
  const auto a = scratch.write("in/a.ply", ply), deep = scratch.write("in/deeper/b.ply", ply);
  const auto broken = scratch.write("in/c.ply", "ply\nbroken\n");
  scratch.write("in/control_points.txt", "1 2 3\n4 5 6\n");
  FilesConfig config;
  config.input.recursive = config.input.skip_damaged = true;
  const std::vector<ScanInput> inputs = expand_inputs({scratch / "in"}, config);
  REQUIRE(inputs.size() == 2);
  CHECK(inputs[0].name == a);
  CHECK(inputs[1].name == deep);
  CHECK_THROWS_WITH(expand_inputs({broken}, config), Contains("no other file is left"));
}

TEST_CASE("a file whose own count is trusted is not damaged") {
  const ScratchFolder scratch;
  test::LasFile las{.points = {test::las_point(20, 1, 2, 3), test::las_point(20, 4, 5, 6)}};
  std::string bytes = las.bytes();
  test::put(bytes, 107, std::uint32_t{1});
  const auto file = scratch.write("a.las", bytes);
  FilesConfig config;
  config.input.skip_damaged = true;
  CHECK_THROWS_WITH(expand_inputs({file}, config), Contains("the header counts 1 points, but 2 whole ones"));
  config.input.trust = Trust::kFile;
  CHECK(expand_inputs({file}, config).size() == 1);
}

TEST_CASE("a pose follows a name in a list, as numbers or as the file that holds them") {
  const ScratchFolder scratch;
  scratch.write("turned.xf", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
  const auto list =
      scratch.write("list.txt", "\"a b.xyz\" pose=turned.xf\nc.xyz\tpose=4 5 6 0 0 0 1\nd.xyz\npose=e.xyz\n");
  const std::vector<ScanInput> inputs = expand_inputs({as_list(list)});
  REQUIRE(inputs.size() == 4);
  CHECK(inputs[0].name == scratch / "a b.xyz");
  CHECK(inputs[0].pose->translation() == Eigen::Vector3d(1, 2, 3));
  CHECK(inputs[1].name == scratch / "c.xyz");
  CHECK(inputs[1].pose->translation() == Eigen::Vector3d(4, 5, 6));
  CHECK_FALSE(inputs[2].pose);
  CHECK(inputs[3].name == scratch / "pose=e.xyz");
  CHECK_FALSE(inputs[3].pose);
  check_list_refused("d.xyz\na.xyz pose=1 2 3\n", "list.txt: line 2: a pose of 3 numbers");
  check_list_refused("a.xyz pose=none.xf\n", "none.xf");
}

TEST_CASE("a pose in a list may be the viewpoint of a PCD, whose scanner stands there then") {
  const ScratchFolder scratch;
  std::string pcd = test::ascii_pcd("1 2 3\n4 5 6\n", "10 20 30");
  pcd.replace(pcd.find(" 1 0 0 0"), 8, " 0.70710678 0 0 0.70710678");  // a quarter turn around z
  scratch.write("a.pcd", pcd);
  scratch.write("b.xyz", "1 2 3\n");
  const ScanFiles scan(expand_inputs({as_list(scratch.write("list.txt", "a.pcd pose=viewpoint\n"))}), {});
  PointBatch batch;
  REQUIRE(ScanPass(scan).next(batch));
  CHECK((batch.positions[0] - Eigen::Vector3d(8, 21, 33)).norm() < 1e-6);
  const auto reader = scan.open(0);
  REQUIRE(reader->scanners().size() == 1);
  CHECK((reader->scanners()[0].place - Eigen::Vector3d(10, 20, 30)).norm() < 1e-6);
  CHECK(ScanFiles(inputs_of(kept_names(scan)), {}).open(0)->scanners()[0].place ==
        reader->scanners()[0].place);
  check_list_refused((scratch / "b.xyz").string() + " pose=viewpoint\n", "b.xyz has no VIEWPOINT");
}

TEST_CASE("a folder without a scan, an empty list and one that is missing are errors that name them") {
  const ScratchFolder scratch;
  fs::create_directory(scratch / "none");
  CHECK_THROWS_WITH(expand_inputs({scratch / "none"}), Contains("none: no scan file in this folder"));
  check_list_refused("# nothing\n", "names no file");
  for (const auto& [given, reason] :
       {std::pair{"@missing.txt", "missing.txt: cannot be opened"},
        {"", "a scan without a name; allowed: files, folders and @LIST"},
        {"s*.laz", "s*.laz: no file of this name; a pattern works without quotes"}})
    CHECK_THROWS_WITH(expand_inputs({given}), Contains(reason));
}

// An EPT folder of tiles of two points each.
struct Ept {
  ScratchFolder scratch;
  fs::path folder = scratch / "ept", data = folder / "ept-data";

  Ept() {
    fs::create_directories(data);
    write("ept.json", R"({"dataType": "laszip", "points": 6})");
    for (const char* tile : {"0-0-0-0", "1-0-0-0", "2-0-0-1"}) write_tile(tile, 2);
  }
  void write(const std::string& name, const std::string& bytes) const { scratch.write("ept/" + name, bytes); }
  void write_tile(const std::string& name, int points) const {
    test::LasFile las;
    for (int i = 0; i < points; ++i) las.points.push_back(test::las_point(20, i, 0, 0));
    write("ept-data/" + name + ".laz", las.bytes());
  }
  std::string error() const {
    return test::error_of([&] { files_of({folder}); });
  }
};

TEST_CASE("a folder of Entwine's point tiles is the scan in its files") {
  const Ept ept;
  const Paths tiles = {ept.data / "0-0-0-0.laz", ept.data / "1-0-0-0.laz", ept.data / "2-0-0-1.laz"};
  CHECK(files_of({ept.folder}) == tiles);
  CHECK(files_of({ept.folder / "ept.json"}) == tiles);
  for (const auto& [json, part] : {std::pair{R"({"dataType": "zstandard"})", "allowed: laszip"},
                                   {"{}", "has no \"dataType\""},
                                   {"[]", "an ept.json is needed"}}) {
    ept.write("ept.json", json);
    CHECK_THAT(ept.error(), Contains(part));
  }
}

TEST_CASE("point tiles with other points than ept.json counts are an error, which --skip-damaged ends") {
  const auto fails = [](const Ept& ept, const std::string& reason) {
    CHECK_THAT(ept.error(), Contains(reason) && Contains("; --skip-damaged reads the tiles that are there"));
    FilesConfig skipping;
    skipping.input.skip_damaged = true;
    CHECK(expand_inputs({ept.folder}, skipping).size() >= 2);
  };
  const std::string missing = "ept.json: counts 6 points, but its tiles have 4; tiles are missing";
  Ept without, more, shorter, uncounted;
  fs::remove(without.data / "2-0-0-1.laz");
  fails(without, missing);
  more.write_tile("3-0-0-0", 2);
  fails(more, "but its tiles have 8");
  shorter.write_tile("2-0-0-1", 1);
  fails(shorter, "but its tiles have 5");
  uncounted.write("ept.json", R"({"dataType": "laszip"})");
  fails(uncounted, "ept.json: has no number \"points\"");
}

}  // namespace
}  // namespace lacuna::tools
