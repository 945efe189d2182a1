// SPDX-License-Identifier: Apache-2.0
// Rows on disk: what was written, holes, and files cut short.
#include "engine/store/column.hpp"

#include "engine/run/parallel.hpp"
#include "engine/store/rows.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/system.hpp"
#include "tests/support/test.hpp"

#include <unistd.h>

namespace lacuna {
namespace {

// `count` numbers from `first` on.
std::vector<std::uint64_t> numbers(std::uint64_t first, std::size_t count) {
  std::vector<std::uint64_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = first + i;
  return numbers;
}

TEST_CASE(
    "rows that were never written are zeros as long as a later one was, and beyond that there are none") {
  const ScratchFolder folder;
  Column<std::uint64_t> column(folder / "column");
  CHECK(column.size() == 0);
  CHECK(column.read(0, 0).empty());
  const std::vector<std::uint64_t> written = {7, 8, 9};
  column.write(100'000, written);
  column.write(10, written);
  CHECK(column.size() == 100'003);
  CHECK(column.read(8, 7) == std::vector<std::uint64_t>{0, 0, 7, 8, 9, 0, 0});
  std::vector<std::uint64_t> used(4, 99);
  column.read(99'999, std::span(used));
  CHECK(used == std::vector<std::uint64_t>{0, 7, 8, 9});
#ifdef NDEBUG  // otherwise it is an assert
  CHECK_THROWS_AS(column.read(100'002, 2), Error);
  CHECK_THROWS_AS(column.read(1'000'000, 1), Error);
#endif
}

TEST_CASE("records of rows in ascending order are read in runs, with gaps of any size, up to the last row") {
  const ScratchFolder folder;
  Column<std::uint64_t> column(folder / "column");
  column.write(0, numbers(0, 5000));
  ColumnReader<std::uint64_t> reader(column);
  Random random(1);
  for (std::uint64_t row = 0; row < 5000; row += std::uint64_t(random.whole(0, 400)))
    CHECK(reader[row] == row);
  CHECK(reader[4999] == 4999);
}

TEST_CASE("what was appended to a column is read back") {
  const ScratchFolder folder;
  Column<std::uint64_t> column(folder / "numbers");
  Random random(1);
  for (std::uint64_t next = 0; next < 200'000;) {
    const auto count = std::size_t(random.whole(0, 3000));
    CHECK(column.append(numbers(next, count)) == next);
    next += count;
    CHECK(column.size() == next);
    const auto first = std::uint64_t(random.whole(0, std::int64_t(next)));
    const auto some = std::size_t(random.whole(0, std::int64_t(next - first)));
    CHECK(column.read(first, some) == numbers(first, some));
  }
}

TEST_CASE("several threads may append to a column: each piece stays together") {
  const ScratchFolder folder;
  Column<std::uint64_t> column(folder / "numbers");
  std::vector<std::uint64_t> rows(500);
  TaskArena(4).for_each(rows.size(), [&](std::size_t i) { rows[i] = column.append(numbers(1000 * i, i)); });
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) wrong += column.read(rows[i], i) != numbers(1000 * i, i);
  CHECK(wrong == 0);
}

TEST_CASE("a file of the store has no name, never opens one that exists, and is freed with its owner") {
  const ScratchFolder folder;
  const std::string there = folder.write("there", "precious");
  CHECK_THROWS_WITH(StoreFile(there), Contains("there: cannot create: File exists"));
  CHECK(test::read_file(there) == "precious");
  {
    StoreFile file(folder / "file");
    StoreFile moved = std::move(file);
    moved.write(0, std::as_bytes(std::span("bytes")));
    CHECK(test::has_open(getpid(), "file"));
    CHECK(folder.names() == std::vector<std::string>{"there"});
  }
  CHECK_FALSE(test::has_open(getpid(), "file"));
  CHECK_THROWS_AS(StoreFile(folder / "no/such/folder"), Error);
}

TEST_CASE("a column whose file was cut short is an error to read behind the cut, and to write anywhere") {
  const ScratchFolder folder;
  Column<std::uint64_t> column(folder / "column");
  column.write(0, numbers(0, 1000));
  REQUIRE(test::cut_open_file(getpid(), "column"));
  CHECK(column.read(0, 500) == numbers(0, 500));
  const auto names_file = Contains((folder / "column").string() +
                                   ": the file was cut short during the run: 4000 of 8000 bytes are left");
  CHECK_THROWS_WITH(column.read(400, 200), names_file);
  CHECK_THROWS_WITH(column.read(999, 1), names_file);
  // A write behind the end would make a hole of zeros of what was cut off.
  CHECK_THROWS_WITH(column.write(1000, numbers(0, 1)), names_file);
  CHECK_THROWS_WITH(column.write(0, numbers(0, 1)), names_file);
  ColumnReader<std::uint64_t> reader(column);
  CHECK_THROWS_AS(reader[600], Error);
}

TEST_CASE("rows are numbered in ascending order, near together or far apart") {
  Random random(1);
  for (const std::int64_t range : {std::int64_t{0}, std::int64_t{40}, std::int64_t{1'000'000'000'000}}) {
    std::vector<Row> rows;
    for (int i = 0; i < 300; ++i)
      rows.push_back(Row{std::uint64_t(random.whole(1'000'000, 1'000'000 + range))});
    RowNumbers numbers;
    numbers.collect(rows.size(), [&](auto&& add) {
      for (const Row row : rows) add(row);
    });
    LocalIndex expected = 0;
    for (const Row row : std::set<Row>(rows.begin(), rows.end())) {
      CHECK(numbers.number(row) == expected);
      CHECK(numbers.row(expected++) == row);
    }
    CHECK(numbers.size() == expected);
  }
}

}  // namespace
}  // namespace lacuna
