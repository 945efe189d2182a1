// SPDX-License-Identifier: Apache-2.0
// What is held beyond the memory that there is: rows, lists, the pool of lists, sorts and arrays.
#include "engine/run/memory.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/rows.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/sorted_runs.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/system.hpp"

#include <unistd.h>

namespace lacuna {
namespace {

// ---- Rows on disk: what was written, holes, and files cut short

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

// ---- Lists that are appended to

using test::heap_in_use;
using test::Record;

TEST_CASE("lists beyond the budget read back all that was appended, each its own") {
  const ScratchFolder folder;
  constexpr std::size_t kLists = 37;
  // The least budget there is.
  AppendLists<Record> lists({folder.path(), std::make_shared<BufferPool>(0)}, "lists", kLists);
  std::vector<std::vector<Record>> expected(kLists);
  Random random(2);
  std::vector<Record> batch;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const auto list =
        static_cast<std::size_t>(random.chance(0.5) ? 0 : random.whole(0, kLists - 2));  // one stays empty
    batch.clear();
    for (std::int64_t n = random.whole(0, 40); n > 0; --n) batch.push_back({random.next(), i});
    lists.append(list, batch);
    expected[list].insert(expected[list].end(), batch.begin(), batch.end());
    if (i == 2000) {
      lists.drop(3);
      expected[3].clear();
    }
  }
  for (std::size_t list = 0; list < kLists; ++list) {
    INFO("list " << list);
    std::vector<Record> read = lists.read(list), visited;
    CHECK(lists.count(list) == expected[list].size());
    lists.for_each(list, [&](const Record& record) { visited.push_back(record); });
    std::sort(read.begin(), read.end());
    std::sort(visited.begin(), visited.end());
    CHECK(visited == read);
    std::sort(expected[list].begin(), expected[list].end());
    CHECK(read == expected[list]);
  }
  CHECK(test::has_open(getpid(), "lists"));
}

TEST_CASE(
    "many lists on disk in many small pieces keep their order, in the memory of their budget and a table") {
  const ScratchFolder folder;
  const std::size_t before = heap_in_use();
  constexpr std::uint64_t kLists = 500, kRecords = 500'000;
  AppendLists<std::uint64_t> lists({folder.path(), std::make_shared<BufferPool>(0)}, "lists", kLists);
  for (std::uint64_t i = 0; i < kRecords; ++i) lists.append(i % kLists, i);
  CHECK(heap_in_use() - before < 160 << 10);
  for (const std::size_t list : {0, 1, 499}) {
    const std::vector<std::uint64_t> read = lists.read(list);
    REQUIRE(read.size() == kRecords / kLists);
    for (std::size_t i = 0; i < read.size(); ++i) REQUIRE(read[i] == i * kLists + list);
  }
}

TEST_CASE("lists whose file was cut short are an error to read and to append to, never zeros") {
  const ScratchFolder folder;
  AppendLists<std::uint64_t> lists({folder.path(), std::make_shared<BufferPool>(0)}, "lists", 3);
  for (std::uint64_t i = 0; i < 100'000; ++i) lists.append(i % 3, i);
  REQUIRE(test::cut_open_file(getpid(), "lists"));
  const auto names_file = Contains((folder / "lists").string() + ": the file was cut short");
  for (std::size_t list = 0; list < 3; ++list) {
    CHECK_THROWS_WITH(lists.read(list), names_file);
    CHECK_THROWS_WITH(lists.for_each(list, [](std::uint64_t) {}), names_file);
  }
  const auto go_on = [&] {
    for (std::uint64_t i = 0; i < 100'000; ++i) lists.append(i % 3, i);
  };
  CHECK_THROWS_WITH(go_on(), names_file);
}

TEST_CASE("every record arrives at its tile in the order in which it was added, and few are held back") {
  const ScratchFolder folder;
  AppendLists<std::uint32_t> lists({folder.path(), std::make_shared<BufferPool>(1 << 20)}, "lists", 3);
  std::vector<std::vector<std::uint32_t>> wanted(3);
  Outbox<std::uint32_t> outbox(lists);
  Random random(1);
  for (std::uint32_t record = 0; record < 50'000; ++record) {
    const auto to = static_cast<TileIndex>(random.uniform(0, 2));  // none for the last tile
    wanted[to].push_back(record);
    outbox.add(to, record);
  }
  CHECK(lists.count(0) + lists.count(1) == 3 * 16'384);
  outbox.send();
  outbox.send();  // there is nothing left
  for (TileIndex to = 0; to < 3; ++to) CHECK(lists.read(to) == wanted[to]);
}

// ---- The memory limit as a ledger, and the pool of the lists

TEST_CASE("the ledger refuses what is not left, and has it again after a lease") {
  MemoryLedger ledger(100);
  const MemoryLedger::Lease first = ledger.take(60);
  {
    MemoryLedger::Lease second = ledger.take(40);
    CHECK_THROWS_AS((void)ledger.take(1), std::logic_error);
    const MemoryLedger::Lease moved = std::move(second);
    CHECK_THROWS_AS((void)ledger.take(1), std::logic_error);
  }
  CHECK(ledger.take(40).bytes() == 40);
  CHECK_THROWS_AS((void)ledger.take(41), std::logic_error);
}

TEST_CASE("the parts of a limit add up to less than it") {
  for (const std::uint64_t mib : {64, 100, 1024, 1 << 20}) {
    const Memory memory = Memory::share(mib << 20);
    CHECK(memory.cells + memory.lists + memory.work < memory.limit);
    CHECK(memory.tiles <= memory.work);
    CHECK(memory.reading <= memory.work);
  }
}

bool is_on_disk(const char* file) {
  return test::has_open(getpid(), file);
}

TEST_CASE("an idle list gives way to a busy one") {
  const ScratchFolder folder;
  const auto pool = std::make_shared<BufferPool>(1 << 20);
  const std::vector<std::uint64_t> records(1 << 12, 7);  // 32 KiB
  AppendLists<std::uint64_t> idle({folder.path(), pool}, "idle", 2);
  // Buffers double: these take 768 KiB, and 256 KiB more are too much.
  for (int i = 0; i < 15; ++i) idle.append(0, records);
  for (int i = 0; i < 8; ++i) idle.append(1, records);
  AppendLists<std::uint64_t> busy({folder.path(), pool}, "busy", 1);
  for (int i = 0; i < 4; ++i) busy.append(0, records);
  CHECK(!is_on_disk("idle"));
  for (int i = 0; i < 4; ++i) busy.append(0, records);
  CHECK(is_on_disk("idle"));
  CHECK(!is_on_disk("busy"));
  CHECK(idle.read(0).size() == 15 * records.size());
  CHECK(busy.read(0).size() == 8 * records.size());
}

TEST_CASE("lists that end give their memory back") {
  const ScratchFolder folder;
  const auto pool = std::make_shared<BufferPool>(1 << 20);
  const std::vector<std::uint64_t> records(1 << 16, 7);  // 512 KiB
  for (int i = 0; i < 10; ++i) {
    AppendLists<std::uint64_t> list({folder.path(), pool}, "list", 1);
    list.append(0, records);
    CHECK(!is_on_disk("list"));
  }
}

TEST_CASE("lists of one pool may be filled from several threads") {
  const ScratchFolder folder;
  const auto pool = std::make_shared<BufferPool>(0);
  std::vector<AppendLists<std::uint64_t>> lists;
  for (int i = 0; i < 3; ++i) lists.emplace_back(Spill{folder.path(), pool}, std::to_string(i), 5);
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t t = 0; t < 3; ++t) {
      threads.emplace_back([&lists, t] {
        for (std::uint64_t i = 0; i < 20'000; ++i)
          lists[(i + t) % 3].append(i % 5, std::vector<std::uint64_t>(i % 30, i));
      });
    }
  }
  std::uint64_t sum = 0, expected = 0;
  for (const AppendLists<std::uint64_t>& list : lists)
    for (std::size_t l = 0; l < list.lists(); ++l) list.for_each(l, [&](std::uint64_t i) { sum += i; });
  for (std::uint64_t i = 0; i < 20'000; ++i) expected += 3 * (i % 30) * i;
  CHECK(sum == expected);
}

// ---- Sorting

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

// ---- Arrays in memory, or mapped from files

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
