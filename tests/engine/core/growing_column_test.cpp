// A column that grows, and lists that come in runs.
#include "engine/core/file.hpp"
#include "engine/core/merge_runs.hpp"
#include "engine/core/parallel.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using test::ScratchFolder;

// `count` numbers from `first` on.
std::vector<std::uint64_t> numbers(std::uint64_t first, std::size_t count) {
  std::vector<std::uint64_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = first + i;
  return numbers;
}

}  // namespace

TEST_CASE("what was appended to a growing column is read back, from the file, from memory and from both") {
  const ScratchFolder folder;
  GrowingColumn<std::uint64_t> column(folder / "numbers");
  Random random(1);
  std::vector<std::uint64_t> rows;
  for (std::uint64_t next = 0; next < 200000;) {
    const auto count = std::size_t(random.whole(0, 3000));
    rows.push_back(column.append(numbers(next, count)));
    CHECK(rows.back() == next);
    next += count;
    CHECK(column.size() == next);
    const auto first = std::uint64_t(random.whole(0, std::int64_t(next)));
    const auto some = std::size_t(random.whole(0, std::int64_t(next - first)));
    CHECK(column.read(first, some) == numbers(first, some));
  }
}

TEST_CASE("several threads may append to a growing column: each piece stays together") {
  const ScratchFolder folder;
  GrowingColumn<std::uint64_t> column(folder / "numbers");
  std::vector<std::uint64_t> rows(500);
  Crew(4).for_each(rows.size(), [&](std::size_t i) { rows[i] = column.append(numbers(1000 * i, i)); });
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) wrong += column.read(rows[i], i) != numbers(1000 * i, i);
  CHECK(wrong == 0);
}

TEST_CASE("runs are merged as a stable sort would") {
  Random random(2);
  std::size_t wrong = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::pair<int, int>> records;  // key, place
    for (std::int64_t runs = random.whole(0, 4); runs > 0; --runs) {
      const auto begin = records.size();
      for (std::int64_t i = random.whole(0, 30); i > 0; --i) records.emplace_back(random.whole(0, 20), 0);
      std::sort(records.begin() + std::ptrdiff_t(begin), records.end());
    }
    for (std::size_t i = 0; i < records.size(); ++i) records[i].second = int(i);
    const auto by_key = [](const auto& a, const auto& b) { return a.first < b.first; };
    auto expected = records;
    std::stable_sort(expected.begin(), expected.end(), by_key);
    merge_runs(records, by_key);
    wrong += records != expected;
  }
  CHECK(wrong == 0);
}

}  // namespace lacuna
