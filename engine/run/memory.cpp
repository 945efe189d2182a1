// SPDX-License-Identifier: Apache-2.0
#include "engine/run/memory.hpp"

#include "engine/run/machine.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <malloc.h>

namespace lacuna {
namespace {

// The program, its libraries, threads' stacks, buffers of readers and writers: measured 28 MiB.
constexpr std::uint64_t kProgram = 36 << 20;

// An owner of buffers may hold so many bytes however full the pool is.
constexpr std::uint64_t kLeastBuffers = 1 << 16;

}  // namespace

Memory Memory::share(std::uint64_t limit) {
  if (limit == 0) limit = machine_memory() / 2;
  constexpr std::uint64_t kLeast = 16 << 20;
  const std::uint64_t rest = limit > kProgram + kLeast ? limit - kProgram : kLeast;
  // The remaining share is for memory that the allocator cannot give back at once.
  return {.limit = limit,
          .cells = rest / 6,
          .lists = rest / 8,
          .work = rest * 3 / 5,
          .tiles = rest * 2 / 5,
          .reading = rest * 2 / 5,
          .ledger = MemoryLedger(rest * 3 / 5)};
}

void Memory::trim(double fraction) const {
  if (static_cast<double>(resident_memory().all) > fraction * static_cast<double>(limit)) ::malloc_trim(0);
}

MemoryLedger::Lease MemoryLedger::take(std::uint64_t bytes) {
  std::uint64_t left = left_;
  while (left >= bytes && !left_.compare_exchange_weak(left, left - bytes)) {
  }
  if (left < bytes)
    throw std::logic_error("a stage asks for " + std::to_string(bytes) + " bytes of memory where " +
                           std::to_string(left) + " are left");
  return {*this, bytes};
}

void BufferPool::enter(Buffers& buffers) {
  const std::lock_guard lock(mutex_);
  owners_.push_back(&buffers);
  least_ += kLeastBuffers;
}

void BufferPool::leave(Buffers& buffers) {
  const std::lock_guard lock(mutex_);
  std::erase(owners_, &buffers);
  least_ -= kLeastBuffers;
  held_ -= buffers.held_;
  tables_ -= buffers.table_;
}

void BufferPool::grow(Buffers& buffers, std::uint64_t bytes) {
  buffers.held_ += bytes;
  held_ += bytes;
}

void BufferPool::shrink(Buffers& buffers, std::uint64_t bytes) {
  buffers.held_ -= bytes;
  held_ -= bytes;
}

void BufferPool::grow_table(Buffers& buffers, std::uint64_t bytes) {
  buffers.table_ += bytes;
  tables_ += bytes;
}

void BufferPool::relieve() {
  if (!is_full()) return;
  const auto less = [](const Buffers* a, const Buffers* b) { return a->held_ < b->held_; };
  const std::lock_guard lock(mutex_);
  while (is_full()) (*std::max_element(owners_.begin(), owners_.end(), less))->write_half();
}

bool BufferPool::is_full() const {
  const std::uint64_t tables = tables_;
  return held_ > std::max(bytes_ - std::min(bytes_, tables), least_.load());
}

}  // namespace lacuna
