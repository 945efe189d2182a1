// SPDX-License-Identifier: Apache-2.0
// Files that are read as JSON, and single files that a command writes.
#include "io/read/files/json_file.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/ply/ply_writer.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/system.hpp"

#include <sys/stat.h>

namespace lacuna::io {
namespace {

// ---- JSON

using Event = Json::parse_event_t;

std::string error_of(const std::string& text, const Json::parser_callback_t& keep = {}) {
  const ScratchFolder folder;
  return test::error_of([&] { read_json(folder.write("a.json", text), "a result", keep); });
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST_CASE("JSON that could take any memory is an error of one line", "[io]") {
  CHECK_THAT(error_of("[1, 2"), Contains("a.json: byte 6: is not JSON; a result is needed"));
  CHECK_THAT(error_of(std::string(100'000, '[')), Contains("is nested deeper than 32 levels"));
  const auto drop_a = [](int, Event event, const Json& parsed) {
    return event != Event::key || parsed != "a";
  };
  CHECK_THAT(error_of("{\"a\": " + std::string(100'000, '['), drop_a), Contains("is nested deeper than 32"));
  CHECK_THAT(error_of("{\"a\": \"" + std::string(3 << 20, 'x') + "\"}"),
             Contains("a value of more than 1 MiB"));
  CHECK_THAT(error_of("[" + std::string(3 << 20, '7') + "]"), Contains("a value of more than 1 MiB"));
  CHECK_THAT(error_of("[1e999]"), Contains("beyond those of double precision"));
  CHECK_THAT(error_of("[0" + repeated(",0", 5'000'000) + "]"), Contains("more values than the 4 million"));
  CHECK(error_of("[" + std::string(900'000, ' ') + "]").empty());
  const ScratchFolder folder;
  const auto pipe = folder / "pipe.json";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(test::error_of([&] { read_json(pipe, "a result"); }),
             Contains("is not a regular file; a result is needed"));
}

TEST_CASE("what is left out of JSON does not count, however much it is", "[io]") {
  const std::string text =
      R"({"a": [[0)" + repeated(",[0]", 2'000'000) + R"(]], "b": {"c": [[1], [2]]}, "d": 3})";
  const auto keep = [](int, Event event, const Json& parsed) { return event != Event::key || parsed != "a"; };
  const ScratchFolder folder;
  const fs::path file = folder.write("a.json", text);
  CHECK(read_json(file, "a result", keep) == Json::parse(R"({"b": {"c": [[1], [2]]}, "d": 3})"));
  const auto keep_flat = [](int depth, Event event, const Json&) {
    return depth != 2 || event != Event::array_end;
  };
  const fs::path lists = folder.write("b.json", "[[0" + repeated(",[0]", 5'000'000) + "]]");
  CHECK(read_json(lists, "a result", keep_flat) == Json::parse("[[0]]"));
}

}  // namespace
}  // namespace lacuna::io

namespace lacuna::test {

// ---- Output

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

namespace {

const FileMark kMark("mine:");

void write(const fs::path& file, Overwrite overwrite = Overwrite::kOwn) {
  NewFile out(file, kMark, overwrite);
  out.content().write("mine: new");
  out.commit();
}

}  // namespace

TEST_CASE("a file has its name only once it is complete, and replaces its own kind alone", "[io]") {
  const ScratchFolder folder;
  {
    NewFile out(folder / "a", kMark, Overwrite::kOwn);
    out.content().write("mine: new");
    CHECK_FALSE(fs::exists(folder / "a"));
  }
  CHECK(folder.names().empty());
  write(folder / "a");
  const mode_t mask = umask(0);
  umask(mask);
  CHECK(fs::status(folder / "a").permissions() == static_cast<fs::perms>(0666 & ~mask));
  folder.write("a", "mine: old");
  write(folder / "a");
  CHECK(read_file(folder / "a") == "mine: new");
  CHECK(folder.names() == Names{"a"});
}

TEST_CASE("a file that the command did not write is refused by its name, or replaced on request", "[io]") {
  const ScratchFolder folder;
  for (const std::string content : {"precious", "mine", "", " mine: old"}) {
    const std::string file = folder.write("a", content);
    CHECK(error_of([&] { write(file); }) ==
          file +
              ": exists, and this command did not write it; choose another place, or replace it with "
              "--overwrite");
    CHECK(read_file(file) == content);
    write(file, Overwrite::kAny);
    CHECK(read_file(file) == "mine: new");
  }
}

TEST_CASE("a file that has come to the name meanwhile is not replaced", "[io]") {
  const ScratchFolder folder;
  NewFile out(folder / "a", kMark, Overwrite::kOwn);
  folder.write("a", "precious");
  CHECK_THAT(error_of([&] { out.commit(); }), Contains("a: exists, and this command did not write it"));
  CHECK(read_file(folder / "a") == "precious");
}

TEST_CASE("links, folders, pipes and devices are refused at once, with any option", "[io]") {
  const ScratchFolder folder;
  const std::string target = folder.write("target", "mine: old");
  fs::create_symlink(target, folder / "link");
  fs::create_symlink(folder / "nothing", folder / "broken link");
  fs::create_directory(folder / "folder");
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  const Names before = folder.names();
  for (const Overwrite overwrite : {Overwrite::kOwn, Overwrite::kAny}) {
    const auto error = [&](const fs::path& file) { return error_of([&] { write(file, overwrite); }); };
    CHECK_THAT(error(folder / "link"), Contains("is a symbolic link; only regular files are replaced"));
    CHECK_THAT(error(folder / "broken link"), Contains("is a symbolic link"));
    CHECK_THAT(error(folder / "folder"), Contains("is a folder"));
    CHECK_THAT(error(folder / "pipe"), Contains("is a pipe"));
    CHECK_THAT(error("/dev/null"), Contains("is a device"));
    CHECK_THAT(error(folder / ""), Contains("a file name is needed"));
  }
  CHECK(folder.names() == before);
}

TEST_CASE("a full disk leaves the older file", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "mine: old");
  CHECK_THAT(error_of([&] {
               const FileSizeLimit full(4);
               write(folder / "a");
             }),
             Contains("a: cannot be written: File too large"));
  CHECK(read_file(folder / "a") == "mine: old");
  CHECK(folder.names() == Names{"a"});
}

}  // namespace lacuna::test
