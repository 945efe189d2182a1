// Data on its way through the workspace: columns, lists, sorts, scratch arrays.
#include "engine/core/spill.hpp"

#include "engine/core/error.hpp"
#include "engine/core/external_sort.hpp"
#include "engine/core/file.hpp"
#include "engine/core/scratch.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <thread>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using test::ScratchFolder;

std::size_t count_files(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator{}));
}

struct Record {
  std::uint64_t key, payload;
  friend bool operator<(const Record& a, const Record& b) {
    return a.key != b.key ? a.key < b.key : a.payload < b.payload;
  }
  friend bool operator==(const Record&, const Record&) = default;
};

TEST_CASE("rows of a column that were never written read as zero, inside of it and beyond its end") {
  const ScratchFolder folder;
  Column<std::uint64_t> column(folder / "column");
  const std::vector<std::uint64_t> written = {7, 8, 9};
  column.write(10, written);
  column.write(100'000, written);
  CHECK(column.read(8, 7) == std::vector<std::uint64_t>{0, 0, 7, 8, 9, 0, 0});
  CHECK(column.read(100'002, 3) == std::vector<std::uint64_t>{9, 0, 0});
  CHECK(column.read(1'000'000, 2) == std::vector<std::uint64_t>{0, 0});
  CHECK(column.read(0, 0).empty());
  std::vector<std::uint64_t> used(4, 99);
  column.read(100'001, std::span(used));
  CHECK(used == std::vector<std::uint64_t>{8, 9, 0, 0});
}

TEST_CASE("records of rows in ascending order are read in runs, with gaps of any size") {
  const ScratchFolder folder;
  Column<std::uint64_t> column(folder / "column");
  std::vector<std::uint64_t> squares(5000);
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = i * i;
  column.write(0, squares);
  RunReader<std::uint64_t> reader(column);
  Random random(1);
  for (std::uint64_t row = 0; row < squares.size(); row += std::uint64_t(random.whole(0, 400))) {
    CHECK(reader[row] == row * row);
  }
  CHECK(reader[4999] == 4999 * 4999);
}

TEST_CASE("a workspace file is gone with its owner, and never opens one that exists") {
  const ScratchFolder folder;
  const std::string there = folder.write("there", "precious");
  CHECK_THROWS_AS(ScratchFile(there), Error);
  CHECK(test::read_file(there) == "precious");
  {
    ScratchFile file(folder / "file");
    ScratchFile moved = std::move(file);
    CHECK(std::filesystem::exists(folder / "file"));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "file"));
  CHECK_THROWS_AS(ScratchFile(folder / "no/such/folder"), Error);
}

TEST_CASE("lists beyond the budget read back all that was appended, each its own") {
  const ScratchFolder folder;
  constexpr std::size_t kLists = 37;
  Spill<Record> spill(folder / "spill", kLists, 0);  // the least budget there is
  std::vector<std::vector<Record>> expected(kLists);
  Random random(2);
  std::vector<Record> batch;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const auto list =
        static_cast<std::size_t>(random.chance(0.5) ? 0 : random.whole(0, kLists - 2));  // one stays empty
    batch.clear();
    for (std::int64_t n = random.whole(0, 40); n > 0; --n) batch.push_back({random.next(), i});
    spill.append(list, batch);
    expected[list].insert(expected[list].end(), batch.begin(), batch.end());
    if (i == 2000) {
      spill.drop(3);
      expected[3].clear();
    }
  }
  for (std::size_t list = 0; list < kLists; ++list) {
    INFO("list " << list);
    std::vector<Record> read = spill.read(list), visited;
    CHECK(spill.count(list) == expected[list].size());
    spill.for_each(list, [&](const Record& record) { visited.push_back(record); });
    CHECK(visited == read);
    std::sort(read.begin(), read.end());
    std::sort(expected[list].begin(), expected[list].end());
    CHECK(read == expected[list]);
  }
  CHECK(std::filesystem::file_size(folder / "spill") > 0);
}

TEST_CASE("one thread's appends to a list stay in order") {
  const ScratchFolder folder;
  Spill<std::uint64_t> spill(folder / "spill", 3, 0);
  for (std::uint64_t i = 0; i < 100'000; ++i) spill.append(i % 3, i);
  for (std::size_t list = 0; list < 3; ++list) {
    const std::vector<std::uint64_t> read = spill.read(list);
    CHECK(std::is_sorted(read.begin(), read.end()));
    CHECK(read.size() == (list == 0 ? 33334u : 33333u));
  }
}

TEST_CASE("appends from many threads lose nothing") {
  const ScratchFolder folder;
  Spill<std::uint64_t> spill(folder / "spill", 5, 0);
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 8; ++t) {
    threads.emplace_back([&spill, t] {
      for (std::uint64_t i = 0; i < 20'000; ++i) spill.append((t + i) % 5, t * 20'000 + i);
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::vector<std::uint64_t> all;
  for (std::size_t list = 0; list < 5; ++list) {
    const std::vector<std::uint64_t> read = spill.read(list);
    all.insert(all.end(), read.begin(), read.end());
  }
  std::sort(all.begin(), all.end());
  std::vector<std::uint64_t> expected(160'000);
  std::iota(expected.begin(), expected.end(), 0);
  CHECK(all == expected);
}

TEST_CASE("a sort beyond its budget gives what std::sort gives, twice") {
  for (const std::size_t count : {0u, 1u, 1024u, 1025u, 40'000u}) {
    const ScratchFolder folder;
    ExternalSort<Record, std::less<>> sort(folder / "sort", 0);
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
    }
  }
}

TEST_CASE("scratch arrays within the budget are in memory, those beyond it in files; all are zeroed") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "scratch");
  {
    Scratch scratch(folder / "scratch", 100'000);
    const auto small = scratch.array<std::uint64_t>(1000);
    CHECK(count_files(folder / "scratch") == 0);
    std::vector<std::span<std::uint64_t>> arrays = {small};
    for (int i = 0; i < 5; ++i) arrays.push_back(scratch.array<std::uint64_t>(300'000));
    CHECK(count_files(folder / "scratch") == 5);
    CHECK(scratch.array<std::uint64_t>(0).empty());
    for (const auto& array : arrays) {
      CHECK(std::all_of(array.begin(), array.end(), [](std::uint64_t value) { return value == 0; }));
    }
    Random random(1);
    for (auto& array : arrays) {
      for (std::uint64_t& value : array) {
        value = random.next();
        scratch.breathe();
      }
    }
    Random again(1);
    std::size_t wrong = 0;
    for (const auto& array : arrays) {
      for (const std::uint64_t value : array) wrong += value != again.next();
    }
    CHECK(wrong == 0);
  }
  CHECK(count_files(folder / "scratch") == 0);
}

TEST_CASE("a scratch folder that is not there is an error, not a crash") {
  const ScratchFolder folder;
  Scratch scratch(folder / "none", 0);
  CHECK_THROWS_AS(scratch.array<int>(10), Error);
}

}  // namespace
}  // namespace lacuna
