// SPDX-License-Identifier: Apache-2.0
#include "engine/store/temporary_folder.hpp"

#include "tests/io/io_support.hpp"

#include <future>
#include <optional>

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace lacuna::test {
using namespace io;

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

TEST_CASE("a temporary folder goes with all that it holds, unless it is kept", "[io]") {
  const ScratchFolder folder;
  {
    const TemporaryFolder gone(folder.path(), ".t-");
    TemporaryFolder kept(folder.path(), ".t-");
    fs::create_directory(gone.path() / "sub");
    folder.write(gone.path().filename() / "sub" / "file", "");
    CHECK(find_folders(folder.path(), ".t-").size() == 2);
    kept.keep();
  }
  CHECK(find_folders(folder.path(), ".t-").size() == 1);
  CHECK(error_of([&] { TemporaryFolder(folder / "none", ".t-"); }) ==
        (folder / "none").string() + ": cannot make a temporary folder: No such file or directory");
}

TEST_CASE("before a process ends by a signal its temporary folders go, once nothing is half done", "[io]") {
  const ScratchFolder folder;
  const pid_t child = fork();  // what it removes is gone for good, and it can make no folder any more
  if (child == 0) {
    const TemporaryFolder gone(folder.path(), ".t-");
    TemporaryFolder kept(folder.path(), ".kept-");
    kept.keep();
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
  CHECK(find_folders(folder.path(), ".t-").empty());
  CHECK(find_folders(folder.path(), ".kept-").size() == 1);
}

}  // namespace lacuna::test
