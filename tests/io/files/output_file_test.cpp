// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/output_file.hpp"

#include "io/read/ply/ply_writer.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/system.hpp"

namespace lacuna::test {

TEST_CASE("a file holds what was written to it, however large the pieces", "[io]") {
  const ScratchFolder folder;
  OutputFile out("final name", folder / "a.bin");
  std::string expected;
  for (int i = 0; i < 300'000; ++i) {
    const std::string word = std::to_string(i) + ' ';
    out.write(word);
    expected += word;
  }
  out.write(std::string(5u << 20, 'x'));
  expected += std::string(5u << 20, 'x');
  out.close();
  CHECK(read_file(folder / "a.bin") == expected);
  CHECK(out.path() == "final name");
}

TEST_CASE("the start of a file is overwritten, and what follows goes on behind it", "[io]") {
  const ScratchFolder folder;
  OutputFile out("a.bin", folder / "a.bin");
  const std::string long_text(3u << 20, 'x');
  out.write("????" + long_text);
  out.overwrite_start("1234");
  out.write(std::as_bytes(std::span("end", 3)));
  out.overwrite_start("12");
  out.close();
  CHECK(read_file(folder / "a.bin") == "1234" + long_text + "end");
}

TEST_CASE("a disk that takes no more is an error that names the file", "[io]") {
  const ScratchFolder folder;
  for (const std::size_t bytes : {std::size_t{5001}, std::size_t{3} << 20}) {
    const std::string place = std::to_string(bytes);
    OutputFile out("final/name", folder / place);
    const std::string error = error_of([&] {
      const FileSizeLimit full(5000);
      out.write(std::string(bytes, 'x'));
      out.close();
    });
    CHECK(error == "final/name: cannot be written: File too large");
  }
}

TEST_CASE("a file is created anew: nothing that exists is opened, and no link followed", "[io]") {
  const ScratchFolder folder;
  const std::string other = folder.write("other", "precious");
  fs::create_symlink(other, folder / "link");
  fs::create_symlink(folder / "nothing", folder / "broken link");
  for (const std::string name : {"other", "link", "broken link"})
    CHECK(error_of([&] { OutputFile(name, folder / name); }) == name + ": cannot be created: File exists");
  CHECK(error_of([&] { OutputFile("a", folder / "none" / "a"); }) ==
        "a: cannot be created: No such file or directory");
  CHECK(read_file(other) == "precious");
  CHECK(folder.names() == std::vector<std::string>{"broken link", "link", "other"});
}

}  // namespace lacuna::test
