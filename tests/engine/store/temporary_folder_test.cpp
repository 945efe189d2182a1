// SPDX-License-Identifier: Apache-2.0
#include "engine/store/temporary_folder.hpp"

#include "tests/io/io_support.hpp"
#include "tests/support/system.hpp"

#include <future>

#include <sys/wait.h>
#include <unistd.h>

namespace lacuna::test {

TEST_CASE("a temporary folder goes with all that it holds, and no link is followed", "[io]") {
  const ScratchFolder folder;
  const std::string file = folder.write("file", "x");
  {
    const TemporaryFolder gone(folder.path(), ".t-");
    fs::create_directories(gone.path() / "sub/deeper");
    folder.write(gone.path().filename() / "sub/deeper/file", "");
    fs::create_directory_symlink(folder.path(), gone.path() / "sub/link");
    CHECK(folder.names().size() == 2);
  }
  CHECK(folder.names() == Names{"file"});
  CHECK(error_of([&] { TemporaryFolder(folder / "none", ".t-"); }) ==
        (folder / "none").string() + ": cannot make a temporary folder: No such file or directory");
}

TEST_CASE("what a killed process has left goes, with its mark alone, and nothing else of its name", "[io]") {
  const ScratchFolder folder;
  const auto left = [&] {
    do_apart([&] {
      const TemporaryFolder made(folder.path(), ".t-");
      std::ofstream(made.path() / "file") << "x";
      std::raise(SIGKILL);
    });
    return folder.names();
  };
  const std::string name = left().at(0);
  std::vector<fs::path> rescued;
  CHECK(
      remove_leftovers(folder.path(), ".t-", [&](const fs::path& from) { rescued.push_back(from); }).empty());
  CHECK(rescued == std::vector{folder / name});
  CHECK(folder.names().empty());

  const std::string digits = ".t-0123456789abcde";
  fs::rename(folder / left().at(0), folder / "moved");
  fs::create_directory_symlink(folder / "moved", folder / (digits + "0"));
  fs::copy(folder / "moved", folder / (digits + "1"), fs::copy_options::recursive);
  fs::create_directory(folder / (digits + "2"));
  folder.write(digits + "2/file", "mine");
  fs::permissions(folder / (digits + "2"), fs::perms::sticky_bit, fs::perm_options::add);
  fs::create_directory(folder / (digits + "3"));
  folder.write(digits + "4", "mine");
  const Names before = folder.names();
  const TemporaryFolder own(folder.path(), ".t-");
  CHECK(remove_leftovers(folder.path(), ".t-") == std::vector{own.path()});
  Names after = folder.names();
  std::erase(after, own.path().filename());
  CHECK(after == before);
  CHECK(fs::exists(folder / "moved/file"));
  CHECK(fs::exists(folder / (digits + "2") / "file"));

  // Before the mark and after it, a folder is empty, and sticky.
  fs::remove(folder / (digits + "2") / "file");
  remove_leftovers(folder.path(), ".t-");
  CHECK_FALSE(fs::exists(folder / (digits + "2")));
}

TEST_CASE("before a process ends by a signal its temporary folders go, once nothing is half done", "[io]") {
  const ScratchFolder folder;
  const pid_t child = fork();  // what it removes is gone for good, and it can make no folder any more
  if (child == 0) {
    const TemporaryFolder gone(folder.path(), ".t-");
    std::optional<RemovalPause> pause(std::in_place);
    const auto removal = std::async(std::launch::async, remove_temporary_folders);
    const bool waits = removal.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout;
    const bool stays = fs::exists(gone.path());
    pause.reset();
    removal.wait();
    _exit(waits && stays && !fs::exists(gone.path()) ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  CHECK(folder.names().empty());
}

}  // namespace lacuna::test
