// SPDX-License-Identifier: Apache-2.0
// Arrays in memory, or mapped from files.
#include "engine/store/scratch.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/system.hpp"
#include "tests/support/test.hpp"

#include <unistd.h>

namespace lacuna {
namespace {

std::size_t count_mapped(const fs::path& folder) {
  std::ifstream maps("/proc/self/maps");
  std::size_t count = 0;
  for (std::string line; std::getline(maps, line);) count += line.find(folder.string()) != std::string::npos;
  return count;
}

TEST_CASE(
    "scratch arrays within the budget are in memory, those beyond it in files that nobody can open, and "
    "all are zeroed") {
  const ScratchFolder folder;
  {
    Scratch scratch(folder.path(), 100'000);
    const auto small = scratch.array<std::uint64_t>(1000);
    CHECK(count_mapped(folder.path()) == 0);
    std::vector<std::span<std::uint64_t>> arrays = {small};
    for (int i = 0; i < 5; ++i) arrays.push_back(scratch.array<std::uint64_t>(300'000));
    CHECK(count_mapped(folder.path()) == 5);
    CHECK(folder.names().empty());
    for (int i = 0; i < 5; ++i) CHECK_FALSE(test::has_open(getpid(), "scratch-" + std::to_string(i)));
    CHECK(scratch.array<std::uint64_t>(0).empty());
    for (const auto& array : arrays)
      CHECK(std::all_of(array.begin(), array.end(), [](std::uint64_t value) { return value == 0; }));
    Random random(1);
    for (auto& array : arrays) {
      for (std::uint64_t& value : array) {
        value = random.next();
        scratch.trim();
      }
    }
    Random again(1);
    std::size_t wrong = 0;
    for (const auto& array : arrays)
      for (const std::uint64_t value : array) wrong += value != again.next();
    CHECK(wrong == 0);
  }
  CHECK(count_mapped(folder.path()) == 0);
}

TEST_CASE("a scratch folder that is not there is an error, not a crash") {
  const ScratchFolder folder;
  Scratch scratch(folder / "none", 0);
  CHECK_THROWS_AS(scratch.array<int>(10), Error);
}

}  // namespace
}  // namespace lacuna
