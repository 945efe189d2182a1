// SPDX-License-Identifier: Apache-2.0
// Lists that are appended to, beyond the memory that they have.
#include "engine/store/append_lists.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/record.hpp"
#include "tests/support/system.hpp"

#include <unistd.h>

namespace lacuna {
namespace {

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

}  // namespace
}  // namespace lacuna
