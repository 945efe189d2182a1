// SPDX-License-Identifier: Apache-2.0
// Appends records to a column one at a time.
#pragma once

#include "engine/store/column.hpp"

#include <cstddef>
#include <vector>

namespace lacuna {

// Writes some thousand records together. The last ones are written by `finish`, which has to be called.
template <class Record>
class ColumnWriter {
 public:
  explicit ColumnWriter(Column<Record>& column) : column_(column) {}

  void add(const Record& record) {
    block_.push_back(record);
    if (block_.size() == kTogether) finish();
  }
  void finish() {
    column_.append(block_);
    block_.clear();
  }

 private:
  static constexpr std::size_t kTogether = 4096;

  Column<Record>& column_;
  std::vector<Record> block_;
};

}  // namespace lacuna
