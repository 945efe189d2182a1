// SPDX-License-Identifier: Apache-2.0
// All threading of Lacuna, in oneTBB. A body writes only what its index owns, so that nothing depends on the
// order of threads.
#pragma once

#include "engine/run/memory.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace lacuna {

// Threads to work with. A body may use the same arena again. oneTBB starts no more threads than there are
// cores, unless the process allows it by a tbb::global_control. Arenas do not limit each other.
class TaskArena {
 public:
  explicit TaskArena(std::size_t threads);  // 0: one per core. Throws `Error` if so many cannot be started.
  ~TaskArena();

  std::size_t threads() const;

  // Calls body(i) for every i in [0, count), in any order. An exception in a body ends the loop and is
  // rethrown.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body) const;

  // Runs body i for each of `needs` with bounded memory: it needs `needs[i]` bytes while it runs. Bodies are
  // started in ascending order. Bodies that run together never need more than `budget`. A body that needs
  // more than `budget` runs alone.
  void for_each_within_budget(std::span<const std::uint64_t> needs, std::uint64_t budget,
                              const std::function<void(std::size_t)>& body) const;

  // `produce` fills a slot, `transform` changes several slots at a time, and `consume` takes them in the
  // order produced. A slot is filled again only after that. `produce` returns false at the end.
  void pipeline(const std::function<bool(std::size_t slot)>& produce,
                const std::function<void(std::size_t slot)>& transform,
                const std::function<void(std::size_t slot)>& consume, std::size_t slots) const;

 private:
  void in_arena(const std::function<void()>& work) const;

  struct Arena;
  std::unique_ptr<Arena> arena_;
};

// Threads, and the memory that they work in.
struct Workers {
  TaskArena arena;
  Memory memory;

  // Runs bodies with bounded memory (`TaskArena::for_each_within_budget`), and takes that memory from the
  // ledger.
  void for_each_within(std::uint64_t bytes, std::span<const std::uint64_t> needs,
                       const std::function<void(std::size_t)>& body) const {
    const MemoryLedger::Lease lease = memory.ledger.take(bytes);
    arena.for_each_within_budget(needs, bytes, body);
  }
};

// Returns the threads of the arena that the calling thread works in, for code that runs in a body and knows
// no arena.
std::size_t threads_here();
// Does the same as `for_each`, in that arena. A thread that blocks here may run another body of the outer
// loop in the meantime. So the caller holds no lock and no share of a budget.
void for_each_here(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace lacuna
