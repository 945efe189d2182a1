// SPDX-License-Identifier: Apache-2.0
// Sorts more records than fit in memory. It writes sorted runs to one file, and then merges them.
#pragma once

#include "engine/store/column.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {

// `Less` must be a total order of the records that occur, so that the result does not depend on the runs.
// Memory: `budget` bytes, and never less than 64 KiB, while adding and again while merging. If the budget is
// too small for all runs, runs are merged first into fewer and longer ones, behind the runs in the file. Not
// for use from several threads at once.
template <class Record, class Less = std::less<Record>>
class SortedRuns {
  static_assert(sizeof(Record) <= 1024);  // some fit in the smallest block

 public:
  SortedRuns(std::filesystem::path path, std::uint64_t budget, Less less = {})
      : path_(std::move(path)), capacity_(std::max(budget, kLeastBudget) / sizeof(Record)), less_(less) {}

  void add(const Record& record) {
    if (buffer_.size() == capacity_) write_run();
    ++size_;
    if (buffer_.size() == buffer_.capacity())  // never beyond the budget
      buffer_.reserve(std::clamp<std::size_t>(2 * buffer_.size(), 1, capacity_));
    buffer_.push_back(record);
  }
  void add(std::span<const Record> records) {
    for (const Record& record : records) add(record);
  }
  // Makes space for so many records, within the budget, before the first one.
  void reserve(std::uint64_t records) { buffer_.reserve(std::min<std::uint64_t>(records, capacity_)); }
  std::uint64_t size() const { return size_; }

  // Calls visit(record) in ascending order. It may be called again. Nothing may be added after the first
  // call.
  template <class Visit>
  void for_each(Visit&& visit) {
    if (runs_.empty()) {
      if (!std::exchange(is_sorted_, true)) std::sort(buffer_.begin(), buffer_.end(), less_);
      for (const Record& record : buffer_) visit(record);
      return;
    }
    if (!buffer_.empty()) write_run();
    std::vector<Record>().swap(buffer_);
    while (runs_.size() > most_fronts()) lengthen_runs();
    merge(runs_, visit);
  }

 private:
  static constexpr std::uint64_t kLeastBudget = 64 << 10, kLeastBlock = 8 << 10;  // bytes

  struct Run {
    std::uint64_t begin, end;  // in records
  };
  struct Front {
    std::uint64_t next, end;
    std::vector<Record> block;
    std::size_t at = 0;
  };

  // One block is for the output.
  std::size_t most_fronts() const { return capacity_ * sizeof(Record) / kLeastBlock - 1; }
  std::size_t block(std::size_t fronts) const { return capacity_ / (fronts + 1); }

  void write_run() {
    std::sort(buffer_.begin(), buffer_.end(), less_);
    if (!column_) column_.emplace(path_);
    const std::uint64_t begin = column_->append(buffer_);
    runs_.push_back({begin, begin + buffer_.size()});
    buffer_.clear();
  }

  void lengthen_runs() {
    std::vector<Run> longer;
    std::vector<Record> merged;
    merged.reserve(block(most_fronts()));
    const auto write = [&] {
      longer.back().end = column_->append(merged) + merged.size();
      merged.clear();
    };
    for (std::size_t i = 0; i < runs_.size(); i += most_fronts()) {
      longer.push_back({column_->size(), 0});
      merge(std::span(runs_).subspan(i, std::min(most_fronts(), runs_.size() - i)),
            [&](const Record& record) {
              merged.push_back(record);
              if (merged.size() == block(most_fronts())) write();
            });
      write();
    }
    runs_ = std::move(longer);
  }

  bool refill(Front& front, std::size_t block) const {
    front.block.resize(std::min<std::uint64_t>(block, front.end - front.next));
    column_->read(front.next, front.block);
    front.next += front.block.size();
    front.at = 0;
    return !front.block.empty();
  }

  template <class Visit>
  void merge(std::span<const Run> runs, Visit&& visit) const {
    std::vector<Front> fronts;
    for (const Run& run : runs) fronts.push_back({run.begin, run.end, {}, 0});
    const auto later = [&](std::size_t a, std::size_t b) {
      return less_(fronts[b].block[fronts[b].at], fronts[a].block[fronts[a].at]);
    };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> queue(later);
    for (std::size_t i = 0; i < fronts.size(); ++i) {
      if (refill(fronts[i], block(runs.size()))) queue.push(i);
    }
    while (!queue.empty()) {
      const std::size_t i = queue.top();
      queue.pop();
      Front& front = fronts[i];
      visit(front.block[front.at]);
      if (++front.at < front.block.size() || refill(front, block(runs.size()))) queue.push(i);
    }
  }

  std::filesystem::path path_;
  std::optional<Column<Record>> column_;  // from the first run on
  std::uint64_t capacity_;                // records
  Less less_;
  std::vector<Record> buffer_;
  std::vector<Run> runs_;
  std::uint64_t size_ = 0;
  bool is_sorted_ = false;  // the buffer, of the only run
};

}  // namespace lacuna
