// SPDX-License-Identifier: Apache-2.0
// Fills many runs of a column's rows at once, each from its first row on. Records come in any order of runs.
// The written records of a run are contiguous on disk, so that one read loads the full run.
//
// Each run has a piece of memory of the same size. It gathers the records, and is written when it is full.
// Pieces together stay within the memory given. No piece is larger than makes a write cheaper.
#pragma once

#include "engine/store/column.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lacuna {

template <class Record, class Target = Column<Record>>
class ColumnFiller {
 public:
  ColumnFiller(Target& column, std::vector<std::uint64_t> first_rows, std::uint64_t memory)
      : column_(column),
        next_rows_(std::move(first_rows)),
        gathered_(next_rows_.size()),
        piece_(
            std::clamp<std::uint64_t>(memory / sizeof(Record) / std::max<std::size_t>(next_rows_.size(), 1),
                                      1, kLongestWrite / sizeof(Record))),
        pieces_(std::make_unique_for_overwrite<Record[]>(piece_ * next_rows_.size())) {}

  // Appends records to a run. From any thread, but not two at a time for the same run.
  void append(std::size_t run, std::span<const Record> records) {
    while (!records.empty()) {
      const std::size_t count = std::min<std::size_t>(records.size(), piece_ - gathered_[run]);
      std::copy_n(records.begin(), count, &pieces_[run * piece_ + gathered_[run]]);
      gathered_[run] += static_cast<std::uint32_t>(count);
      records = records.subspan(count);
      if (gathered_[run] == piece_) write(run);
    }
  }

  // Writes the records that are still in memory.
  void finish() {
    for (std::size_t run = 0; run < next_rows_.size(); ++run) write(run);
  }

 private:
  static constexpr std::uint64_t kLongestWrite = 64 << 10;

  void write(std::size_t run) {
    column_.write(next_rows_[run], {&pieces_[run * piece_], gathered_[run]});
    next_rows_[run] += gathered_[run];
    gathered_[run] = 0;
  }

  Target& column_;
  std::vector<std::uint64_t> next_rows_;  // of each run, the first that is not written
  std::vector<std::uint32_t> gathered_;   // records in its piece
  std::uint64_t piece_;                   // records
  std::unique_ptr<Record[]> pieces_;
};

}  // namespace lacuna
