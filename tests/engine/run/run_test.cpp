// SPDX-License-Identifier: Apache-2.0
// The memory that a process may have, and work on several threads.
#include "engine/run/machine.hpp"
#include "engine/run/parallel.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

#include <condition_variable>
#include <latch>

#include <tbb/parallel_for.h>

namespace lacuna {
namespace {

// ---- Memory

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

void write(const ScratchFolder& folder, const std::string& group, const std::string& file,
           const std::string& limit) {
  fs::create_directories(folder / group);
  folder.write(group + "/" + file, limit + "\n");
}

TEST_CASE("a process may have what the tightest of its control groups allows") {
  const ScratchFolder folder;
  const std::string groups = folder.write("groups", "0::/batch/job\n");
  CHECK(group_memory(groups, folder.path()) == kUnlimited);
  write(folder, "batch/job", "memory.max", "max");
  CHECK(group_memory(groups, folder.path()) == kUnlimited);
  write(folder, "batch", "memory.max", "3000000000");
  CHECK(group_memory(groups, folder.path()) == 3'000'000'000);
  write(folder, "batch/job", "memory.max", "2000000000");
  CHECK(group_memory(groups, folder.path()) == 2'000'000'000);
  write(folder, "other", "memory.max", "1");
  CHECK(group_memory(groups, folder.path()) == 2'000'000'000);
}

TEST_CASE("control groups of the first version are by controller, and may name what cannot be seen") {
  const ScratchFolder folder;
  const std::string groups = folder.write("groups", "5:memory:/docker/1234\n4:cpu:/docker/1234\nnonsense\n");
  write(folder, "memory", "memory.limit_in_bytes", "5000000000");
  write(folder, "cpu", "memory.limit_in_bytes", "1");
  CHECK(group_memory(groups, folder.path()) == 5'000'000'000);
  CHECK(group_memory(folder / "none", folder.path()) == kUnlimited);
}

// ---- Threads

// A latch with a bound, which only keeps a failing test from hanging.
class BoundedLatch {
 public:
  // Returns when `count` threads have arrived; false where they have not within a minute.
  bool arrive_and_wait(int count) {
    std::unique_lock lock(mutex_);
    ++arrived_;
    changed_.notify_all();
    return changed_.wait_for(lock, std::chrono::minutes(1), [&] { return arrived_ >= count; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int arrived_ = 0;
};

// Takes as much work on every machine, however busy it is with other things.
void work(int steps) {
  for (int i = 0; i < steps; ++i) std::atomic_signal_fence(std::memory_order_seq_cst);  // keeps the loop
}

TEST_CASE("every index is visited once, with any number of threads") {
  for (const std::size_t threads : {1, 2, 8}) {
    const TaskArena arena(threads);
    std::vector<std::atomic<int>> visits(1000), within(1000);
    arena.for_each(visits.size(), [&](std::size_t i) { ++visits[i]; });
    arena.for_each_within_budget(std::vector<std::uint64_t>(1000, 3), 10,
                                 [&](std::size_t i) { ++within[i]; });
    for (std::size_t i = 0; i < 1000; ++i)
      if (visits[i] != 1 || within[i] != 1) FAIL_CHECK("index " << i << ", " << threads << " threads");
  }
}

TEST_CASE("one thread runs one body at a time, in ascending order") {
  const TaskArena arena(1);
  std::vector<std::size_t> order;
  arena.for_each_within_budget(std::vector<std::uint64_t>(100, 0), 100,
                               [&](std::size_t i) { order.push_back(i); });
  CHECK(order.size() == 100);
  CHECK(std::is_sorted(order.begin(), order.end()));
}

TEST_CASE("bodies that run together never need more than the budget, save one alone") {
  const TaskArena arena(8);
  Random random(1);
  constexpr std::uint64_t kBudget = 100;
  std::vector<std::uint64_t> needs = {50, 50};  // these two run together
  for (int i = 0; i < 300; ++i)
    needs.push_back(std::uint64_t(random.chance(0.05) ? 250 : random.whole(0, 60)));
  BoundedLatch first_two;
  std::atomic<int> together = 0;
  std::mutex mutex;
  std::uint64_t used = 0, running = 0;
  std::size_t over = 0;
  std::vector<std::size_t> started;
  arena.for_each_within_budget(needs, kBudget, [&](std::size_t i) {
    {
      const std::lock_guard lock(mutex);
      used += needs[i];
      ++running;
      over += used > kBudget && running > 1;
      started.push_back(i);
    }
    if (i < 2) together += first_two.arrive_and_wait(2);
    work(5'000);
    const std::lock_guard lock(mutex);
    used -= needs[i];
    --running;
  });
  CHECK(over == 0);
  CHECK(together == 2);
  CHECK(started.size() == needs.size());
}

TEST_CASE("an exception in a body ends the loop and is rethrown") {
  for (const std::size_t threads : {1, 8}) {
    const TaskArena arena(threads);
    std::atomic<int> visits = 0;
    const auto body = [&](std::size_t i) {
      ++visits;
      if (i == 5) throw std::runtime_error("body 5");
    };
    CHECK_THROWS_WITH(arena.for_each_within_budget(std::vector<std::uint64_t>(100'000, 1), 4, body),
                      "body 5");
    CHECK(visits < 100'000);
    CHECK_THROWS_WITH(arena.for_each(10, body), "body 5");
    arena.for_each(10, [&](std::size_t) { ++visits; });  // and the arena goes on working
  }
}

// OpenVDB frees a tree in a loop of oneTBB: where that loop was skipped, the tree leaked.
TEST_CASE("a loop inside of a body is whole, though another body fails meanwhile") {
  const TaskArena arena(2);
  std::atomic<bool> failed = false;
  std::atomic<int> visits = 0;
  const auto fail = [&] {
    failed = true;
    throw std::runtime_error("failed");
  };
  const auto go_on = [&] {
    while (!failed) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    tbb::parallel_for(0, 1000, [&](int) { ++visits; });
  };
  BoundedLatch both;
  CHECK_THROWS_WITH(arena.for_each(2,
                                   [&](std::size_t i) {
                                     both.arrive_and_wait(2);
                                     i == 0 ? fail() : go_on();
                                   }),
                    "failed");
  CHECK(visits == 1000);

  failed = false;
  visits = 0;
  std::latch consuming(1);
  int produced = 0;
  CHECK_THROWS_WITH(arena.pipeline(
                        [&](std::size_t) {
                          if (++produced == 2) {
                            consuming.wait();
                            fail();
                          }
                          return true;
                        },
                        [](std::size_t) {},
                        [&](std::size_t) {
                          consuming.count_down();
                          go_on();
                        },
                        2),
                    "failed");
  CHECK(visits == 1000);
}

TEST_CASE("a body may itself use the arena") {
  const TaskArena arena(4);
  std::atomic<int> sum = 0;
  arena.for_each_within_budget(std::vector<std::uint64_t>(20, 1), 4,
                               [&](std::size_t) { arena.for_each(10, [&](std::size_t) { ++sum; }); });
  CHECK(sum == 200);
}

// It could wait for the memory of the one that is on its own stack: for ever. Threads that help are slow, so
// that the thread has to wait for them.
TEST_CASE("a thread that waits within a body starts no other body meanwhile") {
  static thread_local int bodies_here = 0;
  std::atomic<int> entangled = 0;
  for (int round = 0; round < 100; ++round) {
    const TaskArena arena(3);
    arena.for_each_within_budget(std::vector<std::uint64_t>(3, 1), 3, [&](std::size_t) {
      entangled += bodies_here++ > 0;
      const auto here = std::this_thread::get_id();
      arena.for_each(4, [&](std::size_t) { work(std::this_thread::get_id() == here ? 50'000 : 2'000'000); });
      --bodies_here;
    });
  }
  CHECK(entangled == 0);
}

TEST_CASE("a pipeline consumes in the order produced, and no slot is used again before that") {
  for (const std::size_t threads : {1, 8}) {
    const TaskArena arena(threads);
    constexpr std::size_t kSlots = 5;
    std::vector<int> slot(kSlots, -1), consumed;
    int next = 0;
    arena.pipeline(
        [&](std::size_t s) {
          if (next == 500) return false;
          if (slot[s] != -1) FAIL_CHECK("slot " << s << " is still in use");
          slot[s] = next++;
          return true;
        },
        [&](std::size_t s) {
          if (slot[s] % 7 == 0) work(20'000);
          slot[s] *= 2;
        },
        [&](std::size_t s) {
          consumed.push_back(slot[s]);
          slot[s] = -1;
        },
        kSlots);
    REQUIRE(consumed.size() == 500);
    for (int i = 0; i < 500; ++i)
      if (consumed[static_cast<std::size_t>(i)] != 2 * i) FAIL_CHECK("out of order at " << i);
  }
}

}  // namespace
}  // namespace lacuna
