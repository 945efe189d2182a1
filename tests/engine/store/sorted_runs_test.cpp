// SPDX-License-Identifier: Apache-2.0
// Sorting more than fits in memory.
#include "engine/store/sorted_runs.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/record.hpp"
#include "tests/support/system.hpp"

#include <unistd.h>

namespace lacuna {
namespace {

using test::heap_in_use;
using test::Record;

constexpr std::size_t kRun = (64 << 10) / sizeof(Record);  // within the least budget

TEST_CASE("a sort beyond its budget gives what std::sort gives, twice, however many runs it takes") {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, kRun, kRun + 1, 10 * kRun, 100 * kRun + 7}) {
    const ScratchFolder folder;
    SortedRuns<Record> sort(folder / "sort", 0);
    Random random(count);
    std::vector<Record> expected;
    for (std::size_t i = 0; i < count; ++i) expected.push_back({std::uint64_t(random.whole(0, 300)), i});
    sort.add(expected);
    CHECK(sort.size() == count);
    std::sort(expected.begin(), expected.end());
    for (int pass = 0; pass < 2; ++pass) {
      std::vector<Record> sorted;
      sort.for_each([&](const Record& record) { sorted.push_back(record); });
      CHECK(sorted == expected);
      CHECK(sort.size() == count);
    }
  }
}

TEST_CASE("a sort of very many runs stays within its budget while it merges them") {
  const ScratchFolder folder;
  SortedRuns<Record> sort(folder / "sort", 0);
  constexpr std::size_t kRuns = 500;
  Random random(1);
  const std::size_t before = heap_in_use();
  std::size_t most = 0, visited = 0;
  for (std::size_t i = 0; i < kRuns * kRun; ++i) sort.add({random.next(), i});
  sort.for_each([&](const Record&) {
    if (visited++ % kRun == 0) most = std::max(most, heap_in_use() - before);
  });
  CHECK(visited == kRuns * kRun);
  CHECK(most < 100 << 10);  // 64 KiB, and where each run is
}

TEST_CASE("a sort whose file was cut short is an error, before and while the runs are merged") {
  const ScratchFolder folder;
  const auto names_file = Contains((folder / "sort").string() + ": the file was cut short");
  for (const bool is_merging : {false, true}) {
    SortedRuns<Record> sort(folder / "sort", 0);
    for (std::uint64_t i = 0; i < 100 * kRun; ++i) sort.add({i % 1000, i});
    std::size_t visited = 0;
    const auto merge = [&] {
      sort.for_each([&](const Record&) {
        if (++visited == 10) REQUIRE(test::cut_open_file(getpid(), "sort"));
      });
    };
    if (!is_merging) REQUIRE(test::cut_open_file(getpid(), "sort"));
    CHECK_THROWS_WITH(merge(), names_file);
    CHECK((visited > 0) == is_merging);
  }
}

}  // namespace
}  // namespace lacuna
