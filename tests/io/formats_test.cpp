// SPDX-License-Identifier: Apache-2.0
#include "tests/io/io_support.hpp"

#include <random>

#include <catch2/catch.hpp>
#include <unistd.h>

namespace lacuna::test {
using namespace io;

TEST_CASE("what cannot be opened is an error that names it", "[io]") {
  const ScratchFolder folder;
  CHECK(read_error(folder / "none.ply").find("none.ply: cannot be opened: No such file") !=
        std::string::npos);
  CHECK(read_error(folder.path()).find(": is a folder") != std::string::npos);
  CHECK(read_error("/dev/zero").find("not a regular file") != std::string::npos);
  CHECK(read_error(folder.write("empty.ply", "")).find("empty.ply: byte 0: the file is empty") !=
        std::string::npos);
  const auto locked = folder.write("locked.ply", "1 2 3\n");
  std::filesystem::permissions(locked, std::filesystem::perms::none);
  if (::geteuid() != 0) CHECK(read_error(locked).find("Permission denied") != std::string::npos);
}

TEST_CASE("garbage is an error, and never a crash", "[io]") {
  const ScratchFolder folder;
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    std::string garbage(1 + random() % 3000, ' ');
    for (char& c : garbage) c = static_cast<char>(random());
    CHECK(read_error(folder.write("a.ply", garbage)) != "");
    CHECK(read_error(folder.write("a.ply", "ply\n" + garbage)) != "");
    const std::string error =
        read_error(folder.write("a.ply", "ply\nformat binary_little_endian 1.0\n" + garbage));
    CHECK(error != "");
    CHECK(error.find('\n') == std::string::npos);
  }
}

TEST_CASE("a format is known by its first bytes, not by its name", "[io]") {
  const ScratchFolder folder;
  CHECK(read_table(folder.write("a.ply", "1 2 3\n")).rows.size() == 1);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty int z\nend_header\n";
  CHECK(read_table(folder.write("a.xyz", ply)).rows.empty());
  const std::string unknown = read_error(folder.write("a.las", std::string("\x7f\1\0\0\1\2", 6)));
  CHECK(unknown.find("unknown format; PLY, LAS") != std::string::npos);
}

TEST_CASE("a format that is known but not read is named, with a way out", "[io]") {
  const ScratchFolder folder;
  const auto error = [&](const std::string& bytes) { return read_error(folder.write("a.bin", bytes)); };
  CHECK_THAT(
      error("CCB2\1\0\0\0"),
      Catch::Matchers::Contains("byte 0: this is CloudCompare's BIN, which is not read; CloudCompare"));
  CHECK_THAT(error("\x1f\x8b\x08"),
             Catch::Matchers::Contains("packed by gzip") && Catch::Matchers::Contains("unpack it first"));
  CHECK_THAT(error("ncols 3\nnrows 3\n"), Catch::Matchers::Contains("a grid of Esri"));
  CHECK_THAT(error("  0\r\nSECTION\r\n"), Catch::Matchers::Contains("this is DXF"));
  CHECK_THAT(error("DRACO\2\2"), Catch::Matchers::Contains("this is Draco"));
  CHECK_THAT(read_error(folder.write("a.npz", "PK\3\4")), Catch::Matchers::Contains("an archive of NumPy"));
  CHECK_THAT(read_error(folder.write("a.rcp", "anything")), Catch::Matchers::Contains("Autodesk ReCap"));
  CHECK_THAT(read_error("https://host/a.laz"), Catch::Matchers::Contains("is an address"));
  CHECK_THAT(error("# vtk DataFile Version 3.0\n"), Catch::Matchers::Contains("VTK"));
  CHECK_THAT(error("version https://git-lfs.github.com/spec/v1\noid sha256:1\n"),
             Catch::Matchers::Contains("git lfs pull"));
  CHECK_THAT(error(std::string("\xff\xfe"
                               "1\0 \0",
                               6)),
             Catch::Matchers::Contains("text in UTF-16"));
  CHECK_THAT(error(std::string("\xfe\xff"
                               "\0001",
                               4)),
             Catch::Matchers::Contains("saves it as UTF-8"));
}

TEST_CASE("a file named STL of a size that does not fit is an error with the size that does", "[io]") {
  const ScratchFolder folder;
  const std::string bytes = "made by hand" + std::string(68, '\0') + std::string("\2\0\0\0", 4);
  for (const char* name : {"a.stl", "a.STL"}) {
    CHECK_THAT(read_error(folder.write(name, bytes + std::string(99, '\1'))),
               Catch::Matchers::Contains("byte 183: ") &&
                   Catch::Matchers::Contains("2 triangles, which has 184 bytes"));
    CHECK(read_table(folder.write(name, bytes + std::string(100, '\1'))).rows.size() == 6);
  }
}

}  // namespace lacuna::test
