// SPDX-License-Identifier: Apache-2.0
#include "tools/run/folders.hpp"

#include "engine/run/error.hpp"
#include "io/files/folder_lock.hpp"
#include "tests/support/scratch_folder.hpp"

#include <catch2/catch.hpp>
#include <sys/resource.h>

namespace lacuna::test {
using namespace tools;

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

// As long as it lives, this process can open no more files.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{.rlim_cur = 0, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace

TEST_CASE("a lock that cannot be had is an error that names the folder") {
  const ScratchFolder folder;
  const auto lock = [&](const fs::path& of) {
    const NoMoreFiles limit;
    io::FolderLock lock(of);
  };
  CHECK_THROWS_WITH(lock(folder.path()), folder.path().string() + ": cannot be opened: Too many open files");
  CHECK_THROWS_WITH(io::FolderLock(folder / "none"), Contains("none: cannot be opened: No such file"));
}

TEST_CASE("folders made for a run go if they are empty, and a detour is not made") {
  const ScratchFolder folder;
  {
    const MadeFolder made(folder / "a/b/../c");
    CHECK(made.path() == folder / "a/c");
    CHECK(fs::is_directory(folder / "a/c"));
    CHECK_FALSE(fs::exists(folder / "a/b"));
  }
  CHECK(folder.names().empty());
  { const MadeFolder made(folder / "a/../b/."); }
  CHECK(folder.names().empty());
  {
    const MadeFolder made(folder / "a/../b");
    folder.write("b/result", "");
  }
  CHECK(folder.names() == Names{"b"});
  fs::create_directory(folder / "real");
  fs::create_directory_symlink(folder / "real", folder / "b/link");
  const MadeFolder beside(folder / "b/link/../beside");  // a link leads where it leads
  CHECK(fs::is_directory(folder / "beside"));
}

}  // namespace lacuna::test
