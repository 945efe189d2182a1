// SPDX-License-Identifier: Apache-2.0
#include "engine/run/parallel.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <latch>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

namespace lacuna {
namespace {

std::size_t resolve(std::size_t threads) {
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

// oneTBB ends the program where a thread of its own cannot start the next one. So this starts as many threads
// at the same time, where a failure can still be an error.
void require_threads(std::size_t count) {
  std::latch tried(1);
  std::vector<std::jthread> started;  // joined when `tried` is over
  try {
    while (started.size() + 1 < count) started.emplace_back([&tried] { tried.wait(); });
  } catch (const std::system_error& error) {
    tried.count_down();
    throw Error("cannot start thread " + std::to_string(started.size() + 2) + " of " + std::to_string(count) +
                ": " + error.what() + "; a lower --threads may help");
  }
  tried.count_down();
}

// The first exception of many bodies; the others are not run after it. It never reaches oneTBB, which would
// cancel its loop and skip the loops inside of bodies that still run. OpenVDB frees its trees in such loops.
class FirstError {
 public:
  void run(const std::function<void()>& body) {
    if (is_set_) return;
    try {
      body();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      is_set_ = true;
    }
  }
  bool is_set() const { return is_set_; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
  std::atomic<bool> is_set_ = false;
};

// Hands out indices in ascending order while the needs of the running ones stay within the budget.
class Admission {
 public:
  Admission(std::span<const std::uint64_t> needs, std::uint64_t budget, const FirstError& error)
      : needs_(needs), budget_(budget), error_(error) {}

  std::optional<std::size_t> enter() {
    std::unique_lock lock(mutex_);
    freed_.wait(lock, [&] { return done() || running_ == 0 || used_ + needs_[next_] <= budget_; });
    if (done()) return std::nullopt;
    used_ += needs_[next_];
    ++running_;
    return next_++;
  }

  void leave(std::size_t index) {
    const std::lock_guard lock(mutex_);
    used_ -= needs_[index];
    --running_;
    freed_.notify_all();
  }

 private:
  bool done() const { return error_.is_set() || next_ == needs_.size(); }

  std::span<const std::uint64_t> needs_;
  std::uint64_t budget_;
  std::mutex mutex_;
  std::condition_variable freed_;
  std::size_t next_ = 0;
  std::size_t running_ = 0;
  std::uint64_t used_ = 0;
  const FirstError& error_;
};

}  // namespace

struct TaskArena::Arena {
  explicit Arena(std::size_t threads) : arena(static_cast<int>(threads)) {}
  mutable tbb::task_arena arena;
};

TaskArena::TaskArena(std::size_t threads) : arena_(std::make_unique<Arena>(resolve(threads))) {
  require_threads(resolve(threads));
}
TaskArena::~TaskArena() = default;

std::size_t TaskArena::threads() const {
  return static_cast<std::size_t>(arena_->arena.max_concurrency());
}

// The body is isolated, since it may use its arena itself. While it blocks, oneTBB could give its thread the
// loop that the body is part of. The thread would start another body, or block for ever on memory that its
// own body holds. Isolation of the body alone is not enough, since entering the arena ends it.
void TaskArena::in_arena(const std::function<void()>& work) const {
  arena_->arena.execute([&] { tbb::this_task_arena::isolate(work); });
}

void TaskArena::for_each(std::size_t count, const std::function<void(std::size_t)>& body) const {
  FirstError error;
  const auto work = [&](std::size_t i) { error.run([&] { body(i); }); };
  in_arena([&] { tbb::parallel_for(std::size_t{0}, count, work); });
  error.rethrow();
}

void TaskArena::for_each_within_budget(std::span<const std::uint64_t> needs, std::uint64_t budget,
                                       const std::function<void(std::size_t)>& body) const {
  FirstError error;
  Admission admission(needs, budget, error);
  const auto work = [&](std::size_t) {
    while (const std::optional<std::size_t> index = admission.enter()) {
      error.run([&] { body(*index); });
      admission.leave(*index);
    }
  };
  in_arena([&] { tbb::parallel_for(std::size_t{0}, threads(), work, tbb::simple_partitioner()); });
  error.rethrow();
}

void TaskArena::pipeline(const std::function<bool(std::size_t)>& produce,
                         const std::function<void(std::size_t)>& transform,
                         const std::function<void(std::size_t)>& consume, std::size_t slots) const {
  FirstError error;
  std::size_t next = 0;
  const auto fetch = [&](tbb::flow_control& flow) -> std::size_t {
    const std::size_t slot = next++ % slots;
    bool has_more = false;
    error.run([&] { has_more = produce(slot); });
    if (!has_more) flow.stop();
    return slot;
  };
  const auto change = [&](std::size_t slot) {
    error.run([&] { transform(slot); });
    return slot;
  };
  const auto take = [&](std::size_t slot) { error.run([&] { consume(slot); }); };
  // A slot is used again only after `consume`: the tokens in flight are fewer than the slots.
  in_arena([&] {
    tbb::parallel_pipeline(
        slots, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, fetch) &
                   tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, change) &
                   tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, take));
  });
  error.rethrow();
}

std::size_t threads_here() {
  return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
}

// This loop is not isolated: a thread within in_arena takes no tasks of another isolation, and would not help
// here.
void for_each_here(std::size_t count, const std::function<void(std::size_t)>& body) {
  FirstError error;
  const auto work = [&](std::size_t i) { error.run([&] { body(i); }); };
  tbb::parallel_for(std::size_t{0}, count, work);
  error.rethrow();
}

}  // namespace lacuna
