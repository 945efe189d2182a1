// Sorts more records than fit in memory: sorted runs in one file, then a merge.
#pragma once

#include "engine/core/file.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <queue>
#include <span>
#include <type_traits>
#include <vector>

namespace lacuna {

// `Less` must be a total order of the records that occur, so that the result does not depend on the runs.
// Memory: `budget` bytes while adding, and again while merging. Not for use from several threads at once.
template <class Record, class Less>
class ExternalSort {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  ExternalSort(std::filesystem::path path, std::uint64_t budget, Less less = {})
      : file_(std::move(path)),
        capacity_(std::max<std::uint64_t>(budget / sizeof(Record), 1024)),
        less_(less) {}

  void add(const Record& record) {
    if (buffer_.size() == capacity_) write_run();
    buffer_.push_back(record);
  }
  void add(std::span<const Record> records) {
    for (const Record& record : records) add(record);
  }
  std::uint64_t size() const { return written_ + buffer_.size(); }

  // visit(record) in ascending order. May be called again; nothing may be added after the first call.
  template <class Visit>
  void for_each(Visit&& visit) {
    if (runs_.empty()) {
      std::sort(buffer_.begin(), buffer_.end(), less_);
      for (const Record& record : buffer_) visit(record);
      return;
    }
    if (!buffer_.empty()) write_run();
    std::vector<Record>().swap(buffer_);
    merge(visit);
  }

 private:
  struct Run {
    std::uint64_t begin, end;  // in records
  };
  struct Front {
    std::uint64_t next, end;
    std::vector<Record> block;
    std::size_t at = 0;
  };

  void write_run() {
    std::sort(buffer_.begin(), buffer_.end(), less_);
    file_.write(written_, buffer_);
    runs_.push_back({written_, written_ + buffer_.size()});
    written_ += buffer_.size();
    buffer_.clear();
  }

  bool refill(Front& front, std::size_t block) const {
    front.block.resize(std::min<std::uint64_t>(block, front.end - front.next));
    file_.read(front.next, front.block);
    front.next += front.block.size();
    front.at = 0;
    return !front.block.empty();
  }

  template <class Visit>
  void merge(Visit& visit) const {
    const std::size_t block = std::max<std::size_t>(capacity_ / runs_.size(), 64);
    std::vector<Front> fronts;
    for (const Run& run : runs_) fronts.push_back({run.begin, run.end, {}, 0});
    const auto later = [&](std::size_t a, std::size_t b) {
      return less_(fronts[b].block[fronts[b].at], fronts[a].block[fronts[a].at]);
    };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> queue(later);
    for (std::size_t i = 0; i < fronts.size(); ++i) {
      if (refill(fronts[i], block)) queue.push(i);
    }
    while (!queue.empty()) {
      const std::size_t i = queue.top();
      queue.pop();
      Front& front = fronts[i];
      visit(front.block[front.at]);
      if (++front.at < front.block.size() || refill(front, block)) queue.push(i);
    }
  }

  Column<Record> file_;
  std::uint64_t capacity_;
  Less less_;
  std::vector<Record> buffer_;
  std::vector<Run> runs_;
  std::uint64_t written_ = 0;
};

}  // namespace lacuna
