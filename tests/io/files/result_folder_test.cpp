// SPDX-License-Identifier: Apache-2.0
#include "io/files/result_folder.hpp"

#include "tests/io/io_support.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/small_disk.hpp"

#include <fstream>
#include <functional>

#include <catch2/catch.hpp>
#include <sys/stat.h>

namespace lacuna::test {
using namespace io;

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

void put(const ResultFolder& results, const std::string& name, const std::string& content) {
  const auto file = results.open(name);
  file->write(content);
  file->close();
}

void write(const fs::path& folder, const Names& names, const std::string& content) {
  ResultFolder results(folder);
  for (const std::string& name : names) put(results, name, content);
  results.commit();
}

}  // namespace

TEST_CASE("results have their folder only once all are complete", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "a/out";
  {
    ResultFolder results(out);
    put(results, "one", "1");
    put(results, "points/two", "2");
    CHECK_FALSE(fs::exists(out));
    CHECK(results.commit() == std::vector<fs::path>{out / "one", out / "points"});
    CHECK(read_file(out / "points/two") == "2");
  }
  CHECK(names_of(folder / "a") == Names{"out"});
  CHECK(names_of(out) == Names{".lacuna", "one", "points"});
  const mode_t mask = umask(0);
  umask(mask);
  CHECK(fs::status(out).permissions() == static_cast<fs::perms>(0777 & ~mask));
}

TEST_CASE("an earlier result changes places with the new one, with all that it has", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  write(out, {"a", "b", "points/c"}, "old");
  fs::permissions(out, fs::perms::owner_all);
  {
    ResultFolder results(out);
    put(results, "a", "new");
    CHECK(results.earlier_files() ==
          std::vector<fs::path>{out / ".lacuna", out / "a", out / "b", out / "points/c"});
  }
  CHECK(read_file(out / "a") == "old");  // without commit
  write(out, {"a"}, "new");
  CHECK(names_of(out) == Names{".lacuna", "a"});
  CHECK(read_file(out / "a") == "new");
  CHECK(fs::status(out).permissions() == fs::perms::owner_all);
  CHECK(folder.names() == Names{"out"});
}

TEST_CASE("an empty folder, and one behind a link, take the results", "[io]") {
  const ScratchFolder folder;
  fs::create_directory(folder / "empty");
  write(folder / "empty/", {"a"}, "1");
  fs::create_directory_symlink(folder / "empty", folder / "link");
  write(folder / "link", {"a"}, "2");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(read_file(folder / "empty/a") == "2");
  CHECK(folder.names() == Names{"empty", "link"});
}

TEST_CASE("a folder that holds anything else is refused by name, before the work and after it", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  const std::string reason = ": is no result of an earlier run, and the results replace all of the folder; ";
  const std::vector<std::function<void(const fs::path&)>> additions = {
      [](const fs::path& at) { std::ofstream(at) << "mine"; },
      [](const fs::path& at) { fs::create_directory(at); },
      [](const fs::path& at) { fs::create_symlink("nowhere", at); },
      [](const fs::path& at) { REQUIRE(mkfifo(at.c_str(), 0600) == 0); },
  };
  for (const std::string name : {"notes", "points/notes", ".hidden"}) {
    for (const auto& add : additions) {
      write(out, {"a", "points/b"}, "old");
      ResultFolder results(out);
      put(results, "a", "new");
      add(out / name);
      CHECK_THAT(error_of([&] { results.commit(); }), Contains((out / name).string() + reason));
      CHECK_THAT(error_of([&] { write(out, {"a"}, "new"); }), Contains((out / name).string()));
      CHECK(read_file(out / "a") == "old");
      fs::remove(out / name);
    }
  }
  // A list without its file does not matter; a folder without a list is of others.
  fs::remove(out / "a");
  write(out, {"a"}, "new");
  fs::remove(out / ".lacuna");
  CHECK_THAT(error_of([&] { write(out, {"a"}, "new"); }), Contains("out/a" + reason));
}

TEST_CASE("files, broken links, mount points and names of no folder are refused", "[io]") {
  const ScratchFolder folder;
  folder.write("file", "mine");
  fs::create_symlink(folder / "nothing", folder / "broken");
  CHECK_THAT(error_of([&] { ResultFolder results(folder / "file"); }), Contains("file: not a folder"));
  CHECK_THAT(error_of([&] { ResultFolder results(folder / "broken"); }), Contains("which is missing"));
  CHECK_THAT(error_of([&] { ResultFolder results("/"); }), Contains("the name of a folder is needed"));
  CHECK_THAT(error_of([&] { ResultFolder results(folder / "file/out"); }), Contains("file"));
  const SmallDisk disk(folder / "disk", "100k");
  if (!disk.mounted()) return skip("cannot mount a small disk");
  CHECK_THAT(error_of([&] { ResultFolder results(disk.path()); }), Contains("is a mount point"));
}

TEST_CASE("one run at a time writes results of a name, and a killed one leaves nothing for long", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  {
    const ResultFolder first(out);
    CHECK_THAT(error_of([&] { ResultFolder second(out); }), Contains("another run is at work there"));
  }
  fs::create_directories(folder / ".out.lacuna/results");
  folder.write(".out.lacuna/results/a", "half");
  write(out, {"b"}, "1");
  CHECK(names_of(out) == Names{".lacuna", "b"});
  CHECK(folder.names() == Names{"out"});
}

TEST_CASE("a full disk leaves the earlier result", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  write(out, {"a"}, "old");
  CHECK_THAT(error_of([&] {
               const FileSizeLimit full(4);
               write(out, {"a"}, "longer");
             }),
             Contains("out/a: cannot be written: File too large"));
  CHECK(read_file(out / "a") == "old");
  CHECK(folder.names() == Names{"out"});
}

TEST_CASE("a file that a later command has noted goes with the other results", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  write(out, {"a"}, "old");
  for (int i = 0; i < 2; ++i) note_result(out, "report.html");
  folder.write("out/report.html", "page");
  write(out, {"a"}, "new");
  CHECK(names_of(out) == Names{".lacuna", "a"});
  note_result(folder.path(), "a");  // no folder of results
  CHECK(folder.names() == Names{"out"});
}

}  // namespace lacuna::test
