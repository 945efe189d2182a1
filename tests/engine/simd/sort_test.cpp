// Columns sorted side by side, by each instruction set, against the standard library.
#include "engine/simd/sort.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using Rows = std::vector<Batch<double>>;

// Counts the numbers of all columns that are not where the standard library puts them.
std::size_t misplaced(const Rows& rows) {
  Rows sorted = rows;
  sort_rows(sorted.data(), rows.size());
  std::size_t wrong = 0;
  for (std::size_t column = 0; column < kBatchSize; ++column) {
    std::vector<double> expected;
    for (const Batch<double>& row : rows) expected.push_back(row.at[column]);
    std::sort(expected.begin(), expected.end());
    for (std::size_t i = 0; i < rows.size(); ++i) wrong += sorted[i].at[column] != expected[i];
  }
  return wrong;
}

}  // namespace

TEST_CASE("every instruction set that the machine has is tried, with the plainest one among them") {
  CHECK(instruction_sets().size() >= 2);
  std::vector<std::int64_t> tried;
  by_each_instruction_set([&] { tried.push_back(hwy::SupportedTargets()); });
  CHECK(tried == instruction_sets());
}

// What sorts every row of zeros and ones sorts everything (Knuth, 5.3.4, theorem Z).
TEST_CASE("few rows are sorted whatever the numbers") {
  by_each_instruction_set([] {
    std::size_t wrong = 0;
    for (std::size_t count = 1; count <= 12; ++count) {
      for (unsigned first = 0; first < 1u << count; first += kBatchSize) {
        Rows rows(count);
        for (std::size_t i = 0; i < count; ++i) {
          for (unsigned column = 0; column < kBatchSize; ++column)
            rows[i].at[column] = (first + column) >> i & 1;
        }
        wrong += misplaced(rows);
      }
    }
    CHECK(wrong == 0);
  });
}

// Numbers of few kinds, so that many are equal.
TEST_CASE("many rows are sorted, in registers and beyond, and the next row is left alone") {
  by_each_instruction_set([] {
    Random random(9);
    std::size_t wrong = 0;
    for (std::size_t count = 0; count <= 4 * kRowsInRegisters + 3; ++count) {
      Rows rows(count);
      for (Batch<double>& row : rows) {
        for (double& number : row.at) number = double(random.whole(-20, 20));
      }
      wrong += misplaced(rows);
      rows.push_back({{-100, -100, -100, -100, -100, -100, -100, -100}});
      sort_rows(rows.data(), count);
      wrong += rows.back().at[3] != -100;
    }
    CHECK(wrong == 0);
  });
}

}  // namespace lacuna
