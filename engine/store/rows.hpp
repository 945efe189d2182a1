// SPDX-License-Identifier: Apache-2.0
// Some of the rows: as a set, numbered 0, 1, 2, ... in ascending order, and their records of a column. These
// are read and written in runs of rows that are near each other.
#pragma once

#include "engine/model/ids.hpp"
#include "engine/store/column.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lacuna {

// A set of rows, one bit per row. May be read and changed from several threads.
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

// Numbers some of the rows: 0, 1, 2, ... in ascending order. A bitmap over the range of the rows with a
// running count. A look-up is one cache line, and memory is an eighth of a byte per row of the range. Where
// the rows are few and far between, a sorted list takes its place.
class RowNumbers {
 public:
  // for_each(add) calls add(row) for each row, in any order and with repeats allowed. It is run twice.
  // `about`: roughly the number of rows.
  template <class ForEach>
  void collect(std::uint64_t about, ForEach&& for_each) {
    std::uint64_t first = UINT64_MAX, last = 0;
    for_each([&](Row row) {
      first = std::min(first, value(row));
      last = std::max(last, value(row));
    });
    if (first > last) return;
    first_word_ = first / 64;
    const std::uint64_t words = last / 64 - first_word_ + 1;
    is_dense_ = words <= 4 * about + 64;
    if (is_dense_) {
      words_.assign(words, {});
      for_each([&](Row row) { word(row).bits |= std::uint64_t{1} << value(row) % 64; });
      for (Word& word : words_) {
        word.before = size_;
        size_ += static_cast<LocalIndex>(std::popcount(word.bits));
      }
    } else {
      for_each([&](Row row) { list_.push_back(row); });
      std::sort(list_.begin(), list_.end());
      list_.erase(std::unique(list_.begin(), list_.end()), list_.end());
      size_ = static_cast<LocalIndex>(list_.size());
    }
  }

  LocalIndex size() const { return size_; }

  // Returns the number of a row that was collected.
  LocalIndex number(Row row) const {
    if (!is_dense_)
      return static_cast<LocalIndex>(std::lower_bound(list_.begin(), list_.end(), row) - list_.begin());
    const Word& w = words_[value(row) / 64 - first_word_];
    return w.before +
           static_cast<LocalIndex>(std::popcount(w.bits & ((std::uint64_t{1} << value(row) % 64) - 1)));
  }

  // Returns the number of any row, and nothing if the row was not collected.
  std::optional<LocalIndex> find(Row row) const {
    if (!is_dense_) {
      const auto at = std::lower_bound(list_.begin(), list_.end(), row);
      if (at == list_.end() || *at != row) return std::nullopt;
      return static_cast<LocalIndex>(at - list_.begin());
    }
    const std::uint64_t at = value(row) / 64 - first_word_;  // large where it lies before the first
    if (at >= words_.size() || (words_[at].bits >> value(row) % 64 & 1) == 0) return std::nullopt;
    return number(row);
  }

  Row row(LocalIndex number) const {
    if (!is_dense_) return list_[number];
    const auto after = std::upper_bound(words_.begin(), words_.end(), number,
                                        [](LocalIndex n, const Word& w) { return n < w.before; });
    const Word& w = *(after - 1);
    std::uint64_t bits = w.bits;
    for (LocalIndex skip = number - w.before; skip > 0; --skip) bits &= bits - 1;
    const auto place = static_cast<std::uint64_t>(&w - words_.data()) + first_word_;
    return Row{place * 64 + static_cast<std::uint64_t>(std::countr_zero(bits))};
  }

 private:
  struct Word {
    std::uint64_t bits = 0;
    LocalIndex before = 0;
  };
  Word& word(Row row) { return words_[value(row) / 64 - first_word_]; }

  bool is_dense_ = false;
  std::uint64_t first_word_ = 0;
  LocalIndex size_ = 0;
  std::vector<Word> words_;
  std::vector<Row> list_;
};

// Calls visit(begin, end) for runs of `rows`, which ascend. Rows between runs are not touched. Most were
// never written, and to read them would fill the system's cache with zeros.
template <class Visit>
void for_each_run(std::span<const Row> rows, Visit&& visit) {
  constexpr std::uint64_t kNear = 64;
  for (std::size_t begin = 0, end; begin < rows.size(); begin = end) {
    for (end = begin + 1; end < rows.size() && value(rows[end]) <= value(rows[end - 1]) + kNear;) ++end;
    visit(begin, end);
  }
}

// Returns the records from the first to the last of the rows of one run.
template <class Record>
std::vector<Record> read_run(const Column<Record>& column, std::span<const Row> rows) {
  return column.read(value(rows.front()), value(rows.back()) + 1 - value(rows.front()));
}

// Returns the records of rows that ascend and were written.
template <class Record>
std::vector<Record> read_rows(const Column<Record>& column, std::span<const Row> rows) {
  std::vector<Record> records(rows.size());
  for_each_run(rows, [&](std::size_t begin, std::size_t end) {
    const std::uint64_t first = value(rows[begin]);
    const std::vector<Record> run = read_run(column, rows.subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) records[i] = run[value(rows[i]) - first];
  });
  return records;
}

// Writes the records of rows that ascend. Rows between the rows of one run get zeros.
template <class Record>
void write_rows(Column<Record>& column, std::span<const Row> rows, std::span<const Record> records) {
  for_each_run(rows, [&](std::size_t begin, std::size_t end) {
    const std::uint64_t first = value(rows[begin]);
    std::vector<Record> run(value(rows[end - 1]) + 1 - first);
    for (std::size_t i = begin; i < end; ++i) run[value(rows[i]) - first] = records[i];
    column.write(first, run);
  });
}

// Replaces the records of rows that ascend and were written. No other thread writes rows between them.
template <class Record>
void replace_rows(Column<Record>& column, std::span<const Row> rows, std::span<const Record> records) {
  for_each_run(rows, [&](std::size_t begin, std::size_t end) {
    const std::uint64_t first = value(rows[begin]);
    std::vector<Record> run = read_run(column, rows.subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) run[value(rows[i]) - first] = records[i];
    column.write(first, run);
  });
}

}  // namespace lacuna
