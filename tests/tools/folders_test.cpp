// SPDX-License-Identifier: Apache-2.0
#include "tools/run/folders.hpp"

#include "tests/support/system.hpp"

namespace lacuna::test {
using namespace tools;

TEST_CASE("a lock that cannot be had is an error that names the folder") {
  const ScratchFolder folder;
  const auto lock = [&](const fs::path& of) {
    const ResourceLimit no_more_files(RLIMIT_NOFILE, 0);
    FolderLock lock(of);
  };
  CHECK_THROWS_WITH(lock(folder.path()), folder.path().string() + ": cannot be opened: Too many open files");
  CHECK_THROWS_WITH(FolderLock(folder / "none"), Contains("none: cannot be opened: No such file"));
}

TEST_CASE("of commands that make one kept folder at once, one has it, and the others leave it alone") {
  const ScratchFolder folder;
  for (int round = 0; round < 20; ++round) {
    const auto run = [&](const std::function<void()>& wait) {
      const KeptFolder kept(folder / "w");
      wait();
      if (!fs::is_directory(folder / "w")) throw Error("gone");
    };
    CHECK(do_at_once(4, run) == 1);
    fs::remove(folder / "w");  // another one may have made it
  }
}

TEST_CASE("kept and temporary files are not put into results, which are replaced as a whole") {
  const ScratchFolder folder;
  fs::create_directories(folder / "holes/deeper");
  folder.write("holes/holes.json", "{}");
  folder.write("holes/.lacuna", "holes.json\n");
  const auto refuse = [&](const std::string& kept, const std::string& out) {
    require_outside_results(folder / kept, folder / out, "--workspace");
  };
  for (const std::string kept : {"holes", "holes/w", "holes/deeper/w"})
    CHECK_THROWS_WITH(refuse(kept, "other"),
                      Contains("is in the folder of results " + (folder / "holes").string() +
                               "; allowed: another one for --workspace"));
  CHECK_THROWS_WITH(refuse("out/w", "out"), Contains("is in the folder of results"));
  refuse("w", "out");
  refuse("w", "w/out");
  const TemporaryFolder left(folder.path(), ".holes.lacuna-");
  CHECK_THROWS_WITH(refuse(left.path().filename() / "w", "out"),
                    Contains("is in the temporary folder of a run"));
  CHECK_THROWS_WITH(OutFolder(left.path() / "out", "holes.json"), Contains("is in the temporary folder"));
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
