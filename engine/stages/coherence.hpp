// coherence: a candidate stays boundary only while both of its gap neighbours are (paper, 5.1).
#pragma once

#include "engine/data/ids.hpp"

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// One bit per row. Bits of different words may be changed from different threads.
class RowSet {
 public:
  explicit RowSet(std::uint64_t rows) : words_((rows + 63) / 64) {}

  bool contains(Row row) const {
    return std::atomic_ref(words_[value(row) / 64]).load(std::memory_order_relaxed) >> (value(row) % 64) & 1;
  }
  void insert(Row row) { change(row, words_[value(row) / 64] | bit(row)); }
  void erase(Row row) { change(row, words_[value(row) / 64] & ~bit(row)); }

 private:
  static std::uint64_t bit(Row row) { return std::uint64_t{1} << (value(row) % 64); }
  void change(Row row, std::uint64_t word) {
    std::atomic_ref(words_[value(row) / 64]).store(word, std::memory_order_relaxed);
  }

  mutable std::vector<std::uint64_t> words_;
};

// A candidate that has gap neighbours; without any it is none.
struct Candidate {
  Row row;
  Row gap_near, gap_far;
};

// Takes candidates off the boundary until each of these that is left has both of its gap neighbours on it.
// `candidates` in ascending row; only their own bits are changed. True if any was taken off. Repeated over
// parts of a scan, in any order, until no part changes, this gives the greatest fixed point of the whole.
// Cost: n log n.
bool settle_coherence(std::span<const Candidate> candidates, RowSet& boundary);

}  // namespace lacuna
