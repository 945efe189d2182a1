// SPDX-License-Identifier: Apache-2.0
// Records on their way to other tiles.
#pragma once

#include "engine/model/tiling.hpp"
#include "engine/store/append_lists.hpp"

#include <map>
#include <vector>

namespace lacuna {

// Gathers records by the tile that they are for: a list takes few long runs better than many short ones. Not
// from several threads at once; several outboxes may write to the same lists. Memory: 16,384 records.
template <class Record>
class Outbox {
 public:
  explicit Outbox(AppendLists<Record>& lists) : lists_(lists) {}

  void add(TileIndex to, const Record& record) {
    constexpr std::size_t kMost = 1 << 14;
    outbox_[to].push_back(record);
    if (++gathered_ == kMost) send();
  }

  // Sends the gathered records, and at the end the rest.
  void send() {
    for (const auto& [to, records] : outbox_) lists_.append(to, records);
    outbox_.clear();
    gathered_ = 0;
  }

 private:
  AppendLists<Record>& lists_;
  std::map<TileIndex, std::vector<Record>> outbox_;
  std::size_t gathered_ = 0;
};

}  // namespace lacuna
