// SPDX-License-Identifier: Apache-2.0
// Numbers some of the rows: 0, 1, 2, ... in ascending order of rows.
#pragma once

#include "engine/model/ids.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

namespace lacuna {

// A bitmap over the range of the rows with a running count. A look-up is one cache line, and memory is an
// eighth of a byte per row of the range. Where the rows are few and far between, a sorted list takes its
// place.
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

}  // namespace lacuna
