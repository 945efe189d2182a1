// All threading of Lacuna, in oneTBB. A body writes only what its index owns, so that nothing depends on
// the order in which threads come by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace lacuna {

// Threads to work with. A body may use the same arena again.
class TaskArena {
 public:
  explicit TaskArena(std::size_t threads);  // 0: one per core. Throws `Error` if so many cannot be started.
  ~TaskArena();

  std::size_t threads() const;

  // body(i) for every i in [0, count), in any order. An exception in a body ends the loop and is rethrown.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body) const;

  // The same with bounded memory: body i needs `needs[i]` bytes while it runs; bodies are started in
  // ascending order and those running together never need more than `budget`, save one alone that does.
  void for_each_within_budget(std::span<const std::uint64_t> needs, std::uint64_t budget,
                              const std::function<void(std::size_t)>& body) const;

  // What `produce` puts into a slot is changed by `transform`, several slots at a time, and taken by
  // `consume` in the order produced; a slot is filled again only after that. produce: false at the end.
  void pipeline(const std::function<bool(std::size_t slot)>& produce,
                const std::function<void(std::size_t slot)>& transform,
                const std::function<void(std::size_t slot)>& consume, std::size_t slots) const;

 private:
  void in_arena(const std::function<void()>& work) const;

  struct Arena;
  std::unique_ptr<Arena> arena_;
};

// Of the arena that the calling thread works in, for code that is called by a body and knows no arena.
std::size_t threads_here();
// As `for_each`, in that arena. A thread that waits here may meanwhile run another body of the loop outside,
// so the caller holds no lock and no share of a budget.
void for_each_here(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace lacuna
