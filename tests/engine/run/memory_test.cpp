// SPDX-License-Identifier: Apache-2.0
// The memory limit as a ledger, and the pool of the lists.
#include "engine/run/memory.hpp"

#include "engine/store/append_lists.hpp"
#include "tests/support/system.hpp"
#include "tests/support/test.hpp"

#include <unistd.h>

namespace lacuna {
namespace {

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

}  // namespace
}  // namespace lacuna
