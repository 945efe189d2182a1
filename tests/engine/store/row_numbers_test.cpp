// SPDX-License-Identifier: Apache-2.0
#include "engine/store/row_numbers.hpp"

#include "tests/support/clouds.hpp"

#include <set>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

void check_numbers(const std::vector<Row>& rows) {
  RowNumbers numbers;
  numbers.collect(rows.size(), [&](auto&& add) {
    for (const Row row : rows) add(row);
  });
  const std::set<Row> distinct(rows.begin(), rows.end());
  REQUIRE(numbers.size() == distinct.size());
  LocalIndex expected = 0;
  for (const Row row : distinct) {
    CHECK(numbers.number(row) == expected);
    CHECK(numbers.row(expected) == row);
    ++expected;
  }
}

}  // namespace

TEST_CASE("rows are numbered in ascending order, near together or far apart") {
  check_numbers({Row{5}});
  check_numbers({Row{63}, Row{64}, Row{0}, Row{127}, Row{128}, Row{63}});
  Random random(1);
  for (const std::int64_t range : {std::int64_t{40}, std::int64_t{5'000}, std::int64_t{1'000'000'000'000}}) {
    std::vector<Row> rows;
    for (int i = 0; i < 300; ++i)
      rows.push_back(Row{std::uint64_t(random.whole(1'000'000, 1'000'000 + range))});
    check_numbers(rows);
  }
}

TEST_CASE("no rows have no numbers") {
  RowNumbers numbers;
  numbers.collect(0, [](auto&&) {});
  CHECK(numbers.size() == 0);
}

}  // namespace lacuna
