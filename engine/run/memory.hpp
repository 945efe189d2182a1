// SPDX-License-Identifier: Apache-2.0
// The memory limit, who has how much of it, and where the rest goes.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna {

// Hands out memory to the stages that work at the same time, and refuses where they would have more than all
// of it together. From any thread.
class MemoryLedger {
 public:
  explicit MemoryLedger(std::uint64_t bytes) : left_(bytes) {}

  // Gives the bytes back at its end.
  class Lease {
   public:
    Lease(Lease&& other) noexcept : ledger_(std::exchange(other.ledger_, nullptr)), bytes_(other.bytes_) {}
    Lease& operator=(Lease&&) = delete;
    ~Lease() {
      if (ledger_) ledger_->left_ += bytes_;
    }
    std::uint64_t bytes() const { return bytes_; }

   private:
    friend MemoryLedger;
    Lease(MemoryLedger& ledger, std::uint64_t bytes) : ledger_(&ledger), bytes_(bytes) {}
    MemoryLedger* ledger_;
    std::uint64_t bytes_;
  };

  // Throws `std::logic_error` where so many bytes are not left: a stage takes more than was planned for it.
  [[nodiscard]] Lease take(std::uint64_t bytes);

 private:
  std::atomic<std::uint64_t> left_;
};

// The parts of the memory limit. All data of the scan's size is within these parts, save a few bits a point
// (active, coherent, on a loop).
struct Memory {
  std::uint64_t limit;    // all of it; where the config has none, half of what the process may have
  std::uint64_t cells;    // survey and index
  std::uint64_t lists;    // buffers of all lists on their way to disk: a BufferPool
  std::uint64_t work;     // all else, which the ledger hands out
  std::uint64_t tiles;    // of `work`: all tiles at work together
  std::uint64_t reading;  // of `work`: what a reader of the scan may hold
  mutable MemoryLedger ledger;

  static Memory share(std::uint64_t limit);
  // Returns freed memory to the system, if more than this fraction of the limit is in use. Call it at the end
  // of each phase, between steps that need much, and within a phase where the limit is near.
  void trim(double fraction = 0.5) const;
};

// The memory that all lists share for their buffers. Where it is full, the list with the largest buffers
// writes half of them to disk. So no list has a share of its own, and an idle one holds up no other.
class BufferPool {
 public:
  explicit BufferPool(std::uint64_t bytes) : bytes_(bytes) {}

  // Buffers of one list or of several that share a file.
  class Buffers {
   public:
    std::uint64_t held() const { return held_; }

   protected:
    ~Buffers() = default;

   private:
    friend BufferPool;
    // Writes the fullest buffers until at most half of the bytes are held. Called from any thread.
    virtual void write_half() = 0;
    std::atomic<std::uint64_t> held_ = 0, table_ = 0;
  };

  void enter(Buffers& buffers);
  // The owner calls this before it ends.
  void leave(Buffers& buffers);
  // Notes that buffers grew or shrank.
  void grow(Buffers& buffers, std::uint64_t bytes);
  void shrink(Buffers& buffers, std::uint64_t bytes);
  // Notes bytes that are held until the owner leaves.
  void grow_table(Buffers& buffers, std::uint64_t bytes);
  // Makes space where the pool is full. The caller holds no lock that `write_half` takes.
  void relieve();

 private:
  bool is_full() const;

  std::uint64_t bytes_;
  std::atomic<std::uint64_t> held_ = 0, tables_ = 0;
  std::atomic<std::uint64_t> least_ = 0;  // bytes that the owners may hold in any case
  std::mutex mutex_;
  std::vector<Buffers*> owners_;
};

// Where data of a run goes through the disk: columns, lists, and arrays beyond memory.
struct Spill {
  std::filesystem::path folder;
  std::shared_ptr<BufferPool> buffers;  // of all lists; results may outlive the run, and so do their lists

  std::filesystem::path file(std::string_view name) const { return folder / name; }
};

}  // namespace lacuna
