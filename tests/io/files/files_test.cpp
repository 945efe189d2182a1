// SPDX-License-Identifier: Apache-2.0
// Files that are written whole or not at all, one by one and as folders of results, and JSON that is read.
#include "io/read/files/json_file.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/ply/ply.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/system.hpp"

#include <sys/mount.h>
#include <sys/stat.h>

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

namespace {

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
      {
        ResultFolder results(out);
        put(results, "a", "new");
        add(out / name);
        CHECK_THAT(error_of([&] { results.commit(); }), Contains((out / name).string() + reason));
      }
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
  do_apart([&] {
    const ResultFolder half(out);
    put(half, "a", "half");
    std::raise(SIGKILL);
  });
  CHECK_FALSE(temporary_of(out).empty());
  write(out, {"b"}, "1");
  CHECK(names_of(out) == Names{".lacuna", "b"});
  CHECK(folder.names() == Names{"out"});
}

TEST_CASE("folders of others next to the results stay, whatever their names", "[io]") {
  const ScratchFolder folder;
  const Names names = {".out.lacuna", ".out.lacuna-0123456789abcdef", ".out.lacuna-Xy12ab", "mine"};
  for (const std::string& name : names) {
    fs::create_directory(folder / name);
    folder.write(name + "/file", "mine");
  }
  fs::create_directory_symlink("mine", folder / ".out.lacuna-0123456789abcde0");
  const Names before = folder.names();
  write(folder / "out", {"a"}, "old");
  write(folder / "out", {"a"}, "new");
  Names after = folder.names();
  std::erase(after, "out");
  CHECK(after == before);
  for (const std::string& name : names) CHECK(read_file(folder / name / "file") == "mine");
}

TEST_CASE("earlier results that a killed run has moved aside are put back before anything else", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  const auto move_aside = [&](const std::function<void()>& then) {
    write(out, {"a", "points/b"}, "old");
    do_apart([&] {
      const ResultFolder killed(out);
      put(killed, "a", "new");
      fs::rename(out, killed.temporary() / "earlier");
      then();
      std::raise(SIGKILL);
    });
  };
  move_aside([] {});
  REQUIRE_FALSE(fs::exists(out));
  { const ResultFolder stopped(out); }
  CHECK(read_file(out / "points/b") == "old");
  CHECK(folder.names() == Names{"out"});

  move_aside([&] { fs::rename(temporary_of(out) / "results", out); });
  folder.write("out/.lacuna", "a\n");
  { const ResultFolder stopped(out); }
  CHECK(read_file(out / "a") == "new");
  CHECK(folder.names() == Names{"out"});

  move_aside([] {});
  fs::create_directory(out);
  folder.write("out/file", "mine");
  CHECK_THAT(error_of([&] { ResultFolder results(out); }),
             Contains("out: other files have taken the place of earlier results, which are in ") &&
                 Contains("/earlier; allowed: "));
  CHECK(read_file(temporary_of(out) / "earlier/points/b") == "old");
  CHECK(read_file(out / "file") == "mine");
}

TEST_CASE("earlier results that no rename can replace are refused before the work", "[io]") {
  const ScratchFolder folder;
  for (const std::string name : {"low", "up", "work", "merged"}) fs::create_directory(folder / name);
  write(folder / "low/out", {"a"}, "old");
  fs::create_directory(folder / "low/empty");
  // The options' separators may not be in a path.
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  const int failed = ::mount("overlay", "merged", "overlay", 0, "lowerdir=low,upperdir=up,workdir=work");
  fs::current_path(before);
  if (failed != 0) return skip("cannot mount an overlay");
  CHECK_THAT(error_of([&] { ResultFolder results(folder / "merged/out"); }),
             Contains("merged/out: the system cannot replace this folder: Invalid cross-device link"));
  write(folder / "merged/new", {"a"}, "1");
  write(folder / "merged/new", {"a"}, "2");
  write(folder / "merged/empty", {"a"}, "1");
  CHECK(names_of(folder / "merged") == Names{"empty", "new", "out"});
  CHECK(read_file(folder / "merged/out/a") == "old");
  ::umount((folder / "merged").c_str());
}

TEST_CASE("what another program keeps beside an open result says which one is open", "[io]") {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  write(out, {"holes.csv", "loops.gpkg", "points/a.csv"}, "old");
  const std::vector<std::pair<std::string, std::string>> companions = {
      {".~lock.holes.csv#", "holes.csv"},
      {"loops.gpkg-wal", "loops.gpkg"},
      {"loops.gpkg-shm", "loops.gpkg"},
      {"loops.gpkg-journal", "loops.gpkg"},
      {"~$holes.csv", "holes.csv"},
      {"~$les.csv", "holes.csv"},
      {"points/.~lock.a.csv#", "points/a.csv"},
      {".holes.csv.swp", "holes.csv"},
  };
  for (const auto& [companion, file] : companions) {
    folder.write("out/" + companion, "");
    CHECK_THAT(error_of([&] { ResultFolder results(out); }),
               Contains("out/" + companion + ": " + file + " is open in another program; allowed: "));
    fs::remove(out / companion);
  }
  for (const std::string other : {".~lock.other.csv#", "holes.csv.bak", ".~lock.a.csv#"}) {
    folder.write("out/" + other, "");
    CHECK_THAT(error_of([&] { ResultFolder results(out); }),
               Contains(other + ": is no result of an earlier"));
    fs::remove(out / other);
  }
}

TEST_CASE("a name has room for the temporary folder beside it, and an error names the most bytes", "[io]") {
  const ScratchFolder folder;
  write(folder / std::string(230, 'n'), {"a"}, "1");
  for (const std::size_t bytes : {231, 255, 300})
    CHECK_THAT(
        error_of([&] { ResultFolder results(folder / std::string(bytes, 'n')); }),
        Contains(": the name of the folder has " + std::to_string(bytes) + " bytes; allowed: at most 230"));
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

  // A link is no list: it could lead to a file of others.
  const std::string list = folder.write("list", "a\n");
  fs::remove(out / ".lacuna");
  fs::create_symlink(list, out / ".lacuna");
  CHECK_FALSE(is_result_folder(out));
  note_result(out, "report.html");
  CHECK(read_file(list) == "a\n");
  CHECK_THAT(error_of([&] { write(out, {"a"}, "new"); }), Contains("out/.lacuna: is no result"));
}

namespace {

using namespace io;

using Event = Json::parse_event_t;

std::string json_error(const std::string& text, const Json::parser_callback_t& keep = {}) {
  const ScratchFolder folder;
  return error_of([&] { read_json(folder.write("a.json", text), "a result", keep); });
}

TEST_CASE("what is no JSON, nested deeply or no file is an error of one line", "[io]") {
  CHECK_THAT(json_error("[1, 2"), Contains("a.json: byte 6: is not JSON; a result is needed"));
  const std::string deep(100'000, '[');
  const auto drop_all = [](int, Event event, const Json&) { return event != Event::key; };
  CHECK_THAT(json_error(deep), Contains("is nested deeper than 32 levels"));
  CHECK_THAT(json_error("{\"a\": " + deep, drop_all), Contains("is nested deeper than 32"));
  CHECK_THAT(json_error("[1e999]"), Contains("has a number beyond double precision"));
  const ScratchFolder folder;
  const auto pipe = folder / "pipe.json";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(error_of([&] { read_json(pipe, "a result"); }),
             Contains("is not a regular file; a result is needed"));
}

}  // namespace

}  // namespace lacuna::test
