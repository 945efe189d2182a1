#include "engine/core/sorting_network.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

std::vector<int> sorted_by_network(std::vector<int> values, std::size_t wanted) {
  const SortingNetwork network = sorting_network(values.size(), wanted);
  for (std::size_t i = 0; i < network.count; ++i) {
    const auto [low, high] = network.comparisons[i];
    if (values[high] < values[low]) std::swap(values[low], values[high]);
  }
  return values;
}

bool first_are_sorted(const std::vector<int>& values, std::size_t wanted) {
  std::vector<int> expected = values, found = sorted_by_network(values, wanted);
  std::sort(expected.begin(), expected.end());
  return std::equal(expected.begin(), expected.begin() + std::ptrdiff_t(wanted), found.begin());
}

}  // namespace

// What sorts every row of zeros and ones sorts everything (Knuth, 5.3.4, theorem Z).
TEST_CASE("a sorting network of few rows puts the wanted ones first, whatever the numbers") {
  std::size_t wrong = 0;
  for (std::size_t rows = 1; rows <= 12; ++rows) {
    for (std::size_t wanted = 1; wanted <= rows; ++wanted) {
      for (unsigned bits = 0; bits < 1u << rows; ++bits) {
        std::vector<int> values;
        for (std::size_t i = 0; i < rows; ++i) values.push_back(bits >> i & 1);
        wrong += !first_are_sorted(values, wanted);
      }
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("a sorting network of many rows puts the wanted ones first") {
  Random random(4);
  std::size_t wrong = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto rows = std::size_t(random.whole(1, kMostSortedRows));
    const auto wanted = std::size_t(random.whole(1, std::int64_t(rows)));
    std::vector<int> values;
    for (std::size_t i = 0; i < rows; ++i) values.push_back(int(random.whole(0, round % 2 ? 1000 : 1)));
    wrong += !first_are_sorted(values, wanted);
  }
  CHECK(wrong == 0);
}

TEST_CASE("fewer wanted rows need fewer comparisons") {
  CHECK(sorting_network(32, 32).count == 191);  // Batcher's number
  CHECK(sorting_network(32, 17).count < 185);
  CHECK(sorting_network(1, 1).count == 0);
}

// Values of few kinds, so that many are equal.
TEST_CASE("rows of eight are sorted column by column, by every instruction set") {
  std::vector<SortRows*> sets{plain::sort_rows};
#if defined(__x86_64__) && !defined(LACUNA_PORTABLE)
  if (__builtin_cpu_supports("x86-64-v3")) sets.push_back(v3::sort_rows);
  if (__builtin_cpu_supports("x86-64-v4")) sets.push_back(v4::sort_rows);
#endif
  Random random(9);
  std::size_t wrong = 0;
  for (std::size_t count = 0; count <= kMostSortedRows; ++count) {
    const auto wanted = std::size_t(random.whole(0, std::int64_t(count)));
    std::vector<Eight> rows(count + 1);
    for (Eight& row : rows) {
      for (double& number : row.at) number = double(random.whole(-20, 20));
    }
    for (SortRows* const sort : sets) {
      std::vector<Eight> sorted = rows;
      sort(sorted.data(), count, wanted);
      for (std::size_t column = 0; column < kEight; ++column) {
        std::vector<double> expected, found;
        for (std::size_t i = 0; i < count; ++i) expected.push_back(rows[i].at[column]);
        for (std::size_t i = 0; i < wanted; ++i) found.push_back(sorted[i].at[column]);
        std::sort(expected.begin(), expected.end());
        wrong += !std::equal(found.begin(), found.end(), expected.begin());
        wrong += sorted[count].at[column] != rows[count].at[column];  // beyond the last row
      }
    }
  }
  CHECK(wrong == 0);
}

}  // namespace lacuna
