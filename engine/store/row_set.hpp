// SPDX-License-Identifier: Apache-2.0
// A set of rows: a bitmap over all rows.
#pragma once

#include "engine/model/ids.hpp"

#include <atomic>
#include <cstdint>
#include <vector>

namespace lacuna {

// One bit per row. May be read and changed from several threads.
class RowSet {
 public:
  explicit RowSet(std::uint64_t rows) : words_((rows + 63) / 64) {}

  bool contains(Row row) const { return (word(row).load(std::memory_order_relaxed) & bit(row)) != 0; }
  // Inserts a row. Returns false if it was there.
  bool insert(Row row) { return (word(row).fetch_or(bit(row), std::memory_order_relaxed) & bit(row)) == 0; }
  void erase(Row row) { word(row).fetch_and(~bit(row), std::memory_order_relaxed); }

 private:
  static std::uint64_t bit(Row row) { return std::uint64_t{1} << (value(row) % 64); }
  std::atomic_ref<std::uint64_t> word(Row row) const { return std::atomic_ref(words_[value(row) / 64]); }

  mutable std::vector<std::uint64_t> words_;
};

}  // namespace lacuna
