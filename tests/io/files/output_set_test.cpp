// SPDX-License-Identifier: Apache-2.0
#include "io/files/output_set.hpp"

#include "tests/io/io_support.hpp"
#include "tests/support/file_size_limit.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>

#include <catch2/catch.hpp>
#include <sys/stat.h>

namespace lacuna::test {
using namespace io;

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

constexpr std::string_view kMark = "mine:";

// The private folder of a set that is being written.
fs::path private_folder(const ScratchFolder& folder) {
  for (const std::string& name : folder.names()) {
    if (name.starts_with(kTemporaryPrefix)) return folder / name;
  }
  FAIL("no private folder");
  return {};
}

void add(OutputSet& set, const fs::path& file) {
  set.add(file, kMark).write("mine: new");
}

}  // namespace

TEST_CASE("the files of a set have their names only once all are committed", "[io]") {
  const ScratchFolder folder;
  {
    OutputSet set(Overwrite::kOwn);
    add(set, folder / "a");
    add(set, folder / "b");
    REQUIRE(folder.names().size() == 1);
    const auto permissions = fs::status(private_folder(folder)).permissions();
    CHECK((permissions & (fs::perms::group_all | fs::perms::others_all)) == fs::perms::none);
    set.commit();
  }
  CHECK(folder.names() == Names{"a", "b"});
  CHECK(read_file(folder / "a") == "mine: new");
  const mode_t mask = umask(0);
  umask(mask);
  CHECK(fs::status(folder / "a").permissions() == static_cast<fs::perms>(0666 & ~mask));
}

TEST_CASE("without commit nothing is left, and older files stay", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "mine: old");
  {
    OutputSet set(Overwrite::kOwn);
    add(set, folder / "a");
    add(set, folder / "b");
  }
  CHECK(folder.names() == Names{"a"});
  CHECK(read_file(folder / "a") == "mine: old");
}

TEST_CASE("own files are replaced or dropped, and other files stay", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "mine: old");
  folder.write("dropped", "mine: old");
  folder.write("not mine", "precious");
  folder.write("other", "mine: but of another name");
  {
    OutputSet set(Overwrite::kAny);
    add(set, folder / "a");
    set.drop(folder / "dropped", kMark);
    set.drop(folder / "not mine", kMark);
    set.drop(folder / "not there", kMark);
    CHECK(fs::exists(folder / "dropped"));
    set.commit();
  }
  CHECK(folder.names() == Names{"a", "not mine", "other"});
  CHECK(read_file(folder / "a") == "mine: new");
}

TEST_CASE("a file that the command did not write is refused by its name, or replaced on request", "[io]") {
  const ScratchFolder folder;
  for (const std::string content : {"precious", "mine", "", " mine: old"}) {
    const std::string file = folder.write("a", content);
    const std::string expected =
        file +
        ": exists, and this command did not write it; choose another place, or replace it with --overwrite";
    CHECK(error_of([&] { check_output(file, kMark, Overwrite::kOwn); }) == expected);
    CHECK(error_of([&] { add(*std::make_unique<OutputSet>(Overwrite::kOwn), file); }) == expected);
    CHECK(read_file(file) == content);
    OutputSet set(Overwrite::kAny);
    add(set, file);
    set.commit();
    CHECK(read_file(file) == "mine: new");
  }
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
    const auto error = [&](const fs::path& file) {
      return error_of([&] {
        OutputSet set(overwrite);
        add(set, file);
      });
    };
    CHECK(error(folder / "link") ==
          (folder / "link").string() +
              ": is a symbolic link; only regular files are replaced: remove it, or "
              "choose another place");
    CHECK_THAT(error(folder / "broken link"), Contains("is a symbolic link"));
    CHECK_THAT(error(folder / "folder"), Contains("is a folder"));
    CHECK_THAT(error(folder / "pipe"), Contains("is a pipe"));
    CHECK_THAT(error("/dev/null"), Contains("is a device"));
    CHECK_THAT(error(folder / ""), Contains("a file name is needed"));
    CHECK_THAT(error(folder / "none" / "a"), Contains("none: cannot make a temporary folder: No such file"));
  }
  OutputSet set(Overwrite::kAny);
  for (const std::string& name : before) {
    if (name != "target") set.drop(folder / name, kMark);
  }
  set.commit();
  CHECK(folder.names() == before);
  CHECK(read_file(target) == "mine: old");
}

TEST_CASE("a set with one unfinished file leaves the folder as it was", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "mine: old");
  CHECK_THAT(error_of([&] {
               const FileSizeLimit full(100);
               OutputSet set(Overwrite::kOwn);
               add(set, folder / "a");
               set.add(folder / "b", kMark).write(std::string(101, 'x'));
               set.drop(folder / "a", kMark);
               set.commit();
             }),
             Contains("b: cannot be written: File too large"));
  CHECK(folder.names() == Names{"a"});
  CHECK(read_file(folder / "a") == "mine: old");
}

TEST_CASE("where any file cannot take its name, all older files come back", "[io]") {
  const Names names{"a", "b", "c", "d"};
  for (const std::string& failing : names) {
    const ScratchFolder folder;
    for (const std::string name : {"a", "c", "dropped"}) folder.write(name, "mine: old " + name);
    {
      OutputSet set(Overwrite::kOwn);
      for (const std::string& name : names) add(set, folder / name);
      set.drop(folder / "dropped", kMark);
      fs::remove(private_folder(folder) / "new" / failing);
      CHECK(error_of([&] { set.commit(); }) ==
            (folder / failing).string() + ": cannot be put in place: No such file or directory");
    }
    CHECK(folder.names() == Names{"a", "c", "dropped"});
    for (const std::string& name : folder.names()) CHECK(read_file(folder / name) == "mine: old " + name);
  }
}

TEST_CASE("a name that another program has taken during the run is left to it", "[io]") {
  const std::vector<std::function<void(const fs::path&)>> takes = {
      [](const fs::path& file) { std::ofstream(file) << "precious"; },
      [](const fs::path& file) { fs::create_symlink("precious", file); },
      [](const fs::path& file) { fs::create_directories(file / "precious"); },
      [](const fs::path& file) { mkfifo(file.c_str(), 0600); }};
  for (const auto& take : takes) {
    for (const bool was_there : {false, true}) {
      const ScratchFolder folder;
      for (const std::string name : {"a", "c"}) folder.write(name, "mine: old");
      if (was_there) folder.write("b", "mine: old");
      {
        OutputSet set(Overwrite::kAny);
        for (const std::string name : {"a", "b", "c"}) add(set, folder / name);
        fs::remove(folder / "b");
        take(folder / "b");
        const auto before = fs::symlink_status(folder / "b").type();
        CHECK_THAT(error_of([&] { set.commit(); }),
                   Contains("b: another program has written it during the run"));
        CHECK(fs::symlink_status(folder / "b").type() == before);
      }
      CHECK(folder.names() == Names{"a", "b", "c"});
      CHECK(read_file(folder / "a") == "mine: old");
      CHECK(read_file(folder / "c") == "mine: old");
      if (fs::is_regular_file(folder / "b")) CHECK(read_file(folder / "b") == "precious");
      if (fs::is_directory(folder / "b")) CHECK(fs::exists(folder / "b" / "precious"));
    }
  }
}

TEST_CASE("an older file that is removed or written on during the run is none, or another one", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "mine: old");
  {
    OutputSet set(Overwrite::kOwn);
    add(set, folder / "a");
    fs::remove(folder / "a");
    set.commit();
  }
  CHECK(read_file(folder / "a") == "mine: new");
  OutputSet set(Overwrite::kOwn);
  add(set, folder / "a");
  std::ofstream(folder / "a", std::ios::app) << ", and my notes";
  CHECK_THAT(error_of([&] { set.commit(); }), Contains("another program has written it"));
  CHECK(read_file(folder / "a") == "mine: new, and my notes");
}

TEST_CASE("an older file that cannot come back is kept, and the error says where", "[io]") {
  const ScratchFolder folder;
  folder.write("a", "mine: old");
  std::string error;
  {
    // The name is taken when the older file is to come back: by the set itself, which has it twice.
    OutputSet set(Overwrite::kOwn);
    add(set, folder / "." / "a");
    add(set, folder / "a");
    error = error_of([&] { set.commit(); });
  }
  const fs::path kept = private_folder(folder) / "old" / "a";
  CHECK(error == (folder / "a").string() +
                     ": cannot be put in place: File exists; the earlier a is kept as " + kept.string());
  CHECK(read_file(kept) == "mine: old");
}

TEST_CASE("the files of a set may lie in several folders", "[io]") {
  const ScratchFolder folder;
  fs::create_directory(folder / "x");
  fs::create_directory(folder / "y");
  folder.write("x/a", "mine: old");
  {
    OutputSet set(Overwrite::kOwn);
    for (const std::string name : {"x/a", "y/a", "b"}) add(set, folder / name);
    set.commit();
  }
  CHECK(folder.names() == Names{"b", "x", "y"});
  for (const std::string name : {"x/a", "y/a", "b"}) CHECK(read_file(folder / name) == "mine: new");
  CHECK(std::distance(fs::directory_iterator(folder / "x"), {}) == 1);
}

namespace {

void write_in(OutputSet& set, const ScratchFolder& folder, const std::string& name) {
  const auto out = set.open_in(folder.path(), "sub", name, kMark);
  out->write("mine: new");
  out->close_unsynced();
}

Names names_in(const fs::path& folder) {
  Names names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("a subfolder appears with its files, and goes with the last of them", "[io]") {
  const ScratchFolder folder;
  {
    OutputSet set(Overwrite::kOwn);
    for (const std::string name : {"b", "a"}) write_in(set, folder, name);
    add(set, folder / "last");
    CHECK_FALSE(fs::exists(folder / "sub"));
  }
  CHECK(folder.names().empty());
  for (int i = 0; i < 2; ++i) {
    OutputSet set(Overwrite::kOwn);
    for (const std::string name : {"b", "a"}) write_in(set, folder, name);
    add(set, folder / "last");
    CHECK(set.commit() == std::vector<fs::path>{folder / "sub", folder / "last"});
  }
  CHECK(names_in(folder / "sub") == Names{"a", "b"});
  CHECK(read_file(folder / "sub" / "a") == "mine: new");
  const auto drop = [&](const Names& names) {
    OutputSet set(Overwrite::kOwn);
    for (const std::string& name : names) set.drop_in(folder.path(), "sub", name, kMark);
    CHECK(set.commit().empty());
  };
  folder.write("sub/precious", "precious");
  drop({"a", "b", "precious", "not there"});
  CHECK(names_in(folder / "sub") == Names{"precious"});
  fs::remove(folder / "sub" / "precious");
  drop({"a"});
  CHECK(folder.names() == Names{"last", "sub"});  // nothing was dropped there
  folder.write("sub/a", "mine: old");
  drop({"a"});
  CHECK(folder.names() == Names{"last"});
}

TEST_CASE("a commit that fails leaves a subfolder as it was", "[io]") {
  for (const bool was_there : {false, true}) {
    const ScratchFolder folder;
    if (was_there) {
      fs::create_directory(folder / "sub");
      folder.write("sub/a", "mine: old");
    }
    {
      OutputSet set(Overwrite::kOwn);
      write_in(set, folder, "a");
      write_in(set, folder, "b");
      // The name is taken by the set itself, which has it twice.
      add(set, folder / "." / "last");
      add(set, folder / "last");
      CHECK_THAT(error_of([&] { set.commit(); }), Contains("last: cannot be put in place"));
    }
    CHECK(folder.names() == (was_there ? Names{"sub"} : Names{}));
    if (was_there) CHECK(read_file(folder / "sub" / "a") == "mine: old");
  }
}

TEST_CASE("files go to no subfolder that is a link or a file", "[io]") {
  const ScratchFolder folder;
  fs::create_directory(folder / "target");
  fs::create_directory_symlink(folder / "target", folder / "sub");
  const auto error = [&] {
    return error_of([&] {
      OutputSet set(Overwrite::kAny);
      write_in(set, folder, "a");
    });
  };
  CHECK_THAT(error(), Contains("sub: is a symbolic link, and a folder of this name is needed"));
  fs::remove(folder / "sub");
  folder.write("sub", "mine: but a file");
  CHECK_THAT(error(), Contains("sub: is a file"));
  CHECK(folder.names() == Names{"sub", "target"});
  CHECK(fs::is_empty(folder / "target"));
}

}  // namespace lacuna::test
